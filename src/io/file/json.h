#pragma once
// JSON values. The library that parses and prints them is compiled once, in json.cpp.

#include "domelight/base/result.h"

#include <array>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

namespace domelight {

/// A JSON value: null, a boolean, a number, a string, an array or an object. The members of an object keep their order.
///
/// A braced list is an object where each of its elements is a list of a string and a value, else an array:
///
///     Json json{{"size", 256}, {"roughness", {0, 0.5, 1}}};
///     json["levels"].push_back({{"level", 0}});
class Json {
  public:
    using Member = std::pair<std::string, Json>;

    Json() = default;
    Json(std::nullptr_t) {}
    template <typename T>
    requires std::is_arithmetic_v<T> Json(T value) {
        if constexpr (std::is_same_v<T, bool>)
            value_ = value;
        else if constexpr (std::is_floating_point_v<T>)
            value_ = double(value);
        else if constexpr (std::is_signed_v<T>)
            value_ = std::int64_t(value);
        else
            value_ = std::uint64_t(value);
    }
    Json(const char* text) : value_(std::string(text)) {}
    Json(std::string text) : value_(std::move(text)) {}
    Json(std::string_view text) : value_(std::string(text)) {}
    Json(std::initializer_list<Json> list);
    template <typename T>
    Json(const std::vector<T>& elements) : value_(Array(elements.begin(), elements.end())) {}
    template <typename T, std::size_t N>
    Json(const std::array<T, N>& elements) : value_(Array(elements.begin(), elements.end())) {}

    Json(const std::map<std::string, std::string>& members) : value_(Object(members.begin(), members.end())) {}

    static Json array(std::initializer_list<Json> list = {});
    static Json object() { return Json(Object{}); }

    bool is_null() const { return std::holds_alternative<std::monostate>(value_); }
    bool is_boolean() const { return std::holds_alternative<bool>(value_); }
    bool is_string() const { return std::holds_alternative<std::string>(value_); }
    bool is_array() const { return std::holds_alternative<Array>(value_); }
    bool is_object() const { return std::holds_alternative<Object>(value_); }
    bool is_structured() const { return is_array() || is_object(); }
    bool is_number() const { return is_integer() || is_number_float(); }
    bool is_number_float() const { return std::holds_alternative<double>(value_); }
    bool is_number_unsigned() const;  ///< a whole number >= 0, written without a point

    /// The value as T (bool, a number or std::string), which it must hold.
    template <typename T>
    T get() const {
        if constexpr (std::is_same_v<T, bool>)
            return std::get<bool>(value_);
        else if constexpr (std::is_arithmetic_v<T>)
            return std::visit(
                [](const auto& v) {
                    if constexpr (std::is_arithmetic_v<std::decay_t<decltype(v)>>)
                        return T(v);
                    else
                        return T();
                },
                value_);
        else
            return std::get<std::string>(value_);
    }

    /// Elements of an array or members of an object; 0 for anything else.
    std::size_t size() const;
    bool empty() const { return size() == 0; }
    /// The elements of an array; none for anything else.
    const std::vector<Json>& elements() const;
    /// The members of an object; none for anything else.
    const std::vector<Member>& items() const;

    bool contains(std::string_view key) const { return find(key) != nullptr; }
    const Json* find(std::string_view key) const;  ///< the member of an object; null where there is none
    /// The member, made where it is missing; null becomes an object.
    Json& operator[](std::string_view key);
    /// The member or the element; null where there is none.
    const Json& operator[](std::string_view key) const;
    const Json& operator[](std::size_t index) const;

    /// Adds an element; null becomes an array.
    void push_back(Json element);
    /// The last element of an array, which must have one.
    Json& back() { return std::get<Array>(value_).back(); }
    /// Sets each member of another object.
    void update(const Json& other);

    /// As text: on one line, or with `indent` spaces a level. Bytes that are not UTF-8 become U+FFFD.
    std::string dump(int indent = -1) const;
    /// Errors: it is not JSON (the error says where); arrays and objects nested more than 256 deep.
    static Result<Json> parse(std::string_view text);
    /// The same of a regular file of at most 256 MiB; a file that cannot be read is an error, too. Errors name it.
    static Result<Json> read(const std::filesystem::path& file);

    friend bool operator==(const Json& a, const Json& b) { return a.value_ == b.value_; }

  private:
    using Array = std::vector<Json>;
    using Object = std::vector<Member>;
    explicit Json(Object members) : value_(std::move(members)) {}
    bool is_integer() const {
        return std::holds_alternative<std::int64_t>(value_) || std::holds_alternative<std::uint64_t>(value_);
    }
    friend class JsonTree;

    std::variant<std::monostate, bool, std::int64_t, std::uint64_t, double, std::string, Array, Object> value_;
};

}  // namespace domelight
