#pragma once
// The keywords of a Python function, which become the fields of an options struct.

#include "domelight/base/names.h"
#include "domelight/base/vec.h"

#include "base/field_place.h"
#include "errors.h"


#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace domelight::python {

/// Reads keywords from a dictionary. A keyword that is absent or None leaves its field as it is.
///
///     const Keywords words(dictionary);
///     words.read("size", options.size);
///     words.read("lobe", options.lobe);
///
/// An object of another type raises domelight.WrongType, a word that an enumeration does not have domelight.Error; both
/// name the keyword.
class Keywords {
  public:
    explicit Keywords(nb::dict words) : words_(std::move(words)) {}

    bool has(const char* name) const { return !find(name).is_none(); }
    /// None where the keyword is absent.
    nb::object find(const char* name) const;

    void read(const char* name, int& field) const;
    void read(const char* name, std::uint64_t& field) const;
    void read(const char* name, double& field) const;
    void read(const char* name, bool& field) const;
    void read(const char* name, std::string& field) const;
    void read(const char* name, std::vector<double>& field) const;
    void read(const char* name, std::vector<std::string>& field) const;
    void read(const char* name, Mat3& field) const;
    template <NamedEnum E>
    void read(const char* name, E& field) const {
        std::string word;
        if (!has(name)) return;
        read(name, word);
        auto value = from_name<E>(word);
        if (!value) throw Failure(value.error().at(field_place(name)));
        field = *value;
    }
    template <typename T>
    void read(const char* name, std::optional<T>& field) const {
        if (!has(name)) return;
        T value{};
        read(name, value);
        field = std::move(value);
    }

    /// Raises domelight.WrongType: "size: 'large' is a str, expected a whole number".
    [[noreturn]] static void wrong_type(const char* name, nb::handle value, const char* expected);

  private:
    nb::dict words_;
};

/// Raises domelight.Error, which names the keyword, unless low <= value <= high.
void check_within(const char* keyword, double value, double low, double high);

}  // namespace domelight::python
