#include "io/file/json.h"

#include "io/file/file_reader.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <unordered_map>

namespace domelight {
namespace {

constexpr std::size_t k_most_depth = 256;
using Printed = nlohmann::ordered_json;

}  // namespace

/// Builds a Json from the parser's events, and a printable value from a Json.
class JsonTree : public nlohmann::json_sax<nlohmann::json> {
  public:
    bool null() override { return add(Json()); }
    bool boolean(bool value) override { return add(Json(value)); }
    bool number_integer(number_integer_t value) override { return add(Json(std::int64_t(value))); }
    bool number_unsigned(number_unsigned_t value) override { return add(Json(std::uint64_t(value))); }
    bool number_float(number_float_t value, const string_t&) override { return add(Json(value)); }
    bool string(string_t& value) override { return add(Json(std::move(value))); }
    bool binary(binary_t&) override { return false; }
    bool start_object(std::size_t) override { return open(Json::object()); }
    bool start_array(std::size_t) override { return open(Json::array()); }
    bool end_array() override { return close(); }
    bool end_object() override {
        keep_last_of_each_key(std::get<Json::Object>(open_.back().value_));
        return close();
    }
    bool key(string_t& value) override {
        keys_.back() = std::move(value);
        return true;
    }
    bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception& e) override {
        // "[json.exception.parse_error.101] parse error at line 3, column 5: ..."
        const std::string_view message = e.what();
        const std::size_t end = message.find("] ");
        error_ = message.substr(end == message.npos ? 0 : end + 2);
        return false;
    }

    Json take() { return std::move(root_); }
    const std::string& error() const { return error_; }

    static Printed printed(const Json& json) {
        if (json.is_object()) {
            Printed object = Printed::object();
            for (const auto& [key, value] : json.items()) object[key] = printed(value);
            return object;
        }
        if (json.is_array()) {
            Printed array = Printed::array();
            for (const Json& element : json.elements()) array.push_back(printed(element));
            return array;
        }
        return std::visit(
            [](const auto& value) -> Printed {
                using T = std::decay_t<decltype(value)>;
                if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, std::string>)
                    return value;
                else
                    return nullptr;
            },
            json.value_);
    }

  private:
    bool add(Json value) {
        if (open_.empty())
            root_ = std::move(value);
        else if (auto* array = std::get_if<Json::Array>(&open_.back().value_))
            array->push_back(std::move(value));
        else
            std::get<Json::Object>(open_.back().value_).emplace_back(std::move(keys_.back()), std::move(value));
        return true;
    }
    bool open(Json value) {
        if (open_.size() == k_most_depth) {
            error_ = "arrays and objects are nested more than 256 deep";
            return false;
        }
        open_.push_back(std::move(value));
        keys_.emplace_back();
        return true;
    }
    bool close() {
        Json value = std::move(open_.back());
        open_.pop_back();
        keys_.pop_back();
        return add(std::move(value));
    }
    static void keep_last_of_each_key(Json::Object& members) {
        std::unordered_map<std::string_view, std::size_t> last;
        for (std::size_t i = 0; i < members.size(); ++i) last[members[i].first] = i;
        if (last.size() == members.size()) return;
        Json::Object kept;
        for (std::size_t i = 0; i < members.size(); ++i)
            if (last.at(members[i].first) == i) kept.emplace_back(members[i]);
        members = std::move(kept);
    }

    Json root_;
    std::vector<Json> open_;         ///< the arrays and objects around what is parsed
    std::vector<std::string> keys_;  ///< of each of them, the key of the member that comes next
    std::string error_;
};

Json::Json(std::initializer_list<Json> list) {
    const bool members = std::all_of(list.begin(), list.end(), [](const Json& element) {
        return element.is_array() && element.size() == 2 && element[std::size_t(0)].is_string();
    });
    if (!members) {
        value_ = Array(list);
        return;
    }
    Object object;
    object.reserve(list.size());
    for (const Json& element : list)
        object.emplace_back(std::get<std::string>(element[std::size_t(0)].value_), element[std::size_t(1)]);
    value_ = std::move(object);
}

Json Json::array(std::initializer_list<Json> list) {
    Json json;
    json.value_ = Array(list);
    return json;
}

bool Json::is_number_unsigned() const {
    const auto* whole = std::get_if<std::int64_t>(&value_);
    return std::holds_alternative<std::uint64_t>(value_) || (whole && *whole >= 0);
}

std::size_t Json::size() const {
    return is_object() ? items().size() : elements().size();
}

const std::vector<Json>& Json::elements() const {
    static const Array none;
    const auto* array = std::get_if<Array>(&value_);
    return array ? *array : none;
}

const std::vector<Json::Member>& Json::items() const {
    static const Object none;
    const auto* object = std::get_if<Object>(&value_);
    return object ? *object : none;
}

const Json* Json::find(std::string_view key) const {
    const auto& members = items();
    const auto at = std::find_if(members.begin(), members.end(), [&](const Member& m) { return m.first == key; });
    return at == members.end() ? nullptr : &at->second;
}

Json& Json::operator[](std::string_view key) {
    if (is_null()) value_ = Object{};
    auto& members = std::get<Object>(value_);
    const auto at = std::find_if(members.begin(), members.end(), [&](const Member& m) { return m.first == key; });
    return at != members.end() ? at->second : members.emplace_back(std::string(key), Json()).second;
}

const Json& Json::operator[](std::string_view key) const {
    static const Json null;
    const Json* member = find(key);
    return member ? *member : null;
}

const Json& Json::operator[](std::size_t index) const {
    static const Json null;
    return index < elements().size() ? elements()[index] : null;
}

void Json::push_back(Json element) {
    if (is_null()) value_ = Array{};
    std::get<Array>(value_).push_back(std::move(element));
}

void Json::update(const Json& other) {
    for (const auto& [key, value] : other.items()) (*this)[key] = value;
}

std::string Json::dump(int indent) const {
    return JsonTree::printed(*this).dump(indent, ' ', false, Printed::error_handler_t::replace);
}

Result<Json> Json::parse(std::string_view text) {
    JsonTree tree;
    if (nlohmann::json::sax_parse(text.begin(), text.end(), &tree)) return tree.take();
    return Error{"broken JSON: " + tree.error(), "", ""};
}

Result<Json> Json::read(const std::filesystem::path& file) {
    constexpr std::uintmax_t k_most_bytes = std::uintmax_t(1) << 28;
    std::error_code failure;
    if (const auto size = std::filesystem::file_size(file, failure); !failure && size > k_most_bytes)
        return Error{"is larger than 256 MiB", file.string(), ""};
    const auto bytes = FileBytes::open(file, std::int64_t(k_most_bytes), FileKinds::regular);
    if (!bytes) return bytes.error();
    const auto all = (*bytes)->bytes();
    auto json = parse({reinterpret_cast<const char*>(all.data()), all.size()});
    return json ? json : json.error().at(file.string());
}

}  // namespace domelight
