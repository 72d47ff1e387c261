#pragma once

#include "domelight/base/result.h"

#include "io/file/json.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace domelight {

/// Errors: the text is not JSON; the error says where.
Result<Json> parse_json(std::string_view text);

/// The members of a JSON object, read with their types checked. The first fault is kept in an error that all objects of
/// one document share, and reading continues with defaults. The caller checks the error once, at the end.
///
///     std::optional<Error> error;
///     JsonFields root(json, "", error);
///     const int mesh = root.array("nodes")[2].index("mesh", mesh_count);  // error: "nodes[2].mesh: there is no 7,
///     only 3"
class JsonFields {
  public:
    JsonFields(const Json& value, std::string place, std::optional<Error>& error);

    bool has(const char* key) const { return value_->is_object() && value_->contains(key); }
    /// Whether this is an object from the file, and not the empty object that represents a missing member.
    explicit operator bool() const { return value_->is_object(); }

    /// A finite number that fits a float; `fallback` where the member is missing.
    float number(const char* key, float fallback);
    /// The same, clamped to [low, high].
    float number(const char* key, float fallback, float low, float high);
    /// Exactly `count` numbers (any number of them for 0); empty where the member is missing.
    std::vector<float> numbers(const char* key, std::size_t count);
    /// A whole number >= 0; `fallback` where the member is missing.
    std::uint64_t size(const char* key, std::uint64_t fallback);
    /// An index below `limit`; -1 where the member is missing.
    int index(const char* key, std::size_t limit);
    std::vector<int> indices(const char* key, std::size_t limit);
    bool flag(const char* key, bool fallback);
    std::string text(const char* key, const std::string& fallback = "");
    std::vector<std::string> texts(const char* key);
    /// A member that is an object; one without members where it is missing.
    JsonFields object(const char* key);
    /// The objects of an array; none where it is missing.
    std::vector<JsonFields> array(const char* key);
    /// Name and index of each member: the attributes of a primitive.
    std::vector<std::pair<std::string, int>> named_indices(std::size_t limit);
    /// Whether `key` of the object `owner` is true. Any other value, or none, is false and not an error, because extras
    /// may hold anything.
    bool flag_in(const char* owner, const char* key) const;
    /// The same for a finite number.
    std::optional<float> number_in(const char* owner, const char* key) const;
    /// The extension of that name.
    JsonFields extension(const char* name) { return object("extensions").object(name); }

    /// An error if `key` is missing.
    JsonFields& require(const char* key);
    /// Notes that the member `key` (this object itself for "") is wrong.
    void fail(const std::string& key, const std::string& what);
    const std::string& place() const { return place_; }

  private:
    const Json* find(const char* key) const;
    std::string path(std::string_view key) const;

    const Json* value_;
    std::string place_;
    std::optional<Error>* error_;
};

}  // namespace domelight
