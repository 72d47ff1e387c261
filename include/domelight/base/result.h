#pragma once

#include <cassert>
#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace domelight {

/// What went wrong, where, and what to do about it. `format()` gives the lines a program prints after "error: ".
struct Error {
    std::string what;   ///< one sentence without a full stop: "image is 1000 x 600, but a lat-long map must be twice as
                        ///< wide as high"
    std::string where;  ///< file, field or place; may be empty
    std::string hint;   ///< what to do; may be empty

    /// "WHERE: WHAT" and, on a second line, the hint.
    std::string format() const {
        std::string text = where.empty() ? what : where + ": " + what;
        if (!hint.empty()) text += "\n       " + hint;
        return text;
    }
    /// The same error with `where` set to `place`, unless it is already set.
    Error at(std::string place) const { return {what, where.empty() ? std::move(place) : where, hint}; }
};

/// A value or an Error, like a small std::expected. Every function that depends on outside input returns one.
///
///     Result<int> parse(std::string_view text);
///     auto n = parse("12");
///     if (!n) return n.error();
///     use(*n);
template <typename T>
class [[nodiscard]] Result {
  public:
    Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
    Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

    explicit operator bool() const { return state_.index() == 0; }
    T& operator*() & { return value(); }
    const T& operator*() const& { return value(); }
    T&& operator*() && { return std::move(value()); }
    /// The value, or `other` where there is an error.
    T value_or(T other) const { return *this ? value() : other; }
    T* operator->() { return &value(); }
    const T* operator->() const { return &value(); }
    /// Precondition: holds an error.
    const Error& error() const {
        assert(state_.index() == 1);
        return *std::get_if<1>(&state_);
    }

  private:
    T& value() {
        assert(state_.index() == 0);
        return *std::get_if<0>(&state_);
    }
    const T& value() const {
        assert(state_.index() == 0);
        return *std::get_if<0>(&state_);
    }
    std::variant<T, Error> state_;
};

template <>
class [[nodiscard]] Result<void> {
  public:
    Result() = default;
    Result(Error error) : error_(std::move(error)) {}
    explicit operator bool() const { return !error_; }
    /// Precondition: holds an error.
    const Error& error() const {
        assert(error_);
        return *error_;
    }

  private:
    std::optional<Error> error_;
};

}  // namespace domelight
