#pragma once
// The options of a job, from a JSON object into the structs of the library.

#include "domelight/base/names.h"
#include "domelight/base/result.h"
#include "domelight/io/environment/open_environment.h"

#include "base/field_place.h"
#include "io/file/json.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace domelight {

/// Reads the members of an object one after the other. Where a member is missing, the field stays as it is. The first
/// fault is kept; finish() tells of it, or of a member that nothing has read.
class OptionReader {
  public:
    explicit OptionReader(const Json& options) : options_(options) {}

    void read(const char* name, bool& field);
    void read(const char* name, int& field);
    void read(const char* name, std::uint64_t& field);
    void read(const char* name, double& field);
    void read(const char* name, std::string& field);
    void read(const char* name, std::vector<double>& field);
    /// One text, or an array of them.
    void read(const char* name, std::vector<std::string>& field);
    template <NamedEnum E>
    void read(const char* name, E& field) {
        std::string word;
        read(name, word);
        if (!given(name) || error_) return;
        const auto value = from_name<E>(word);
        if (value)
            field = *value;
        else
            fail(value.error().at(field_place(name)));
    }
    template <typename T>
    void read(const char* name, std::optional<T>& field) {
        T value{};
        read(name, value);
        if (given(name) && !error_) field = std::move(value);
    }
    /// A number that must lie in [low, high].
    template <typename T>
    void read(const char* name, T& field, double low, double high) {
        read(name, field);
        check_range(name, double(field), low, high);
    }

    /// One of these words. kind: what they are, "a format". Where the member is missing, the field must be one of them.
    void read_word(const char* name, std::string& field, const std::vector<std::string>& accepted, const char* kind);

    /// For a member that the caller has read itself.
    void know(const char* name) { known_.emplace_back(name); }
    bool given(const char* name) const { return options_.contains(name); }
    void fail(Error error);
    /// Errors: the first fault; a member that is not an option, with the list of those that are.
    Result<void> finish() const;

  private:
    const Json* find(const char* name);
    void wrong_type(const char* name, const char* expected);
    void check_range(const char* name, double value, double low, double high);

    const Json& options_;
    std::vector<std::string> known_;
    std::optional<Error> error_;
};

/// The options of EnvironmentOptions, for every kind of job that opens an environment.
void read_environment_options(OptionReader& reader, EnvironmentOptions& options);

}  // namespace domelight
