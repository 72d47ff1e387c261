#pragma once
// The names of enumerations. An enumeration with names has one table, which stands beside it. Manifests, options, help
// and errors all take its words from there.
//
//     enum class Lobe { ggx, phong_brdf };
//     template <>
//     struct EnumNames<Lobe> {
//         static constexpr const char* kind = "a lobe";
//         static constexpr NamedValue<Lobe> table[] = {{Lobe::ggx, "ggx"}, {Lobe::phong_brdf, "phong"}};
//     };
//
//     name_of(Lobe::ggx);         // "ggx"
//     from_name<Lobe>("phong");   // Lobe::phong_brdf
//     names_of<Lobe>();           // {"ggx", "phong"}

#include "domelight/base/result.h"

#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace domelight {

/// A value and its name.
template <typename T>
struct NamedValue {
    T value;
    std::string_view name;
};

/// The names of the enumeration E, by a specialisation that has
///
///     kind    what E is, for errors: "a lobe"
///     table   an array of NamedValue<E>, in the order in which lists show the names. Every value of E is in it. A
///             value may have further names, which are accepted as well; the first one is name_of()'s
template <typename E>
struct EnumNames;

/// An enumeration with a table of names.
template <typename E>
concept NamedEnum = std::is_enum_v<E> && requires {
    EnumNames<E>::table;
};

/// The name of a value: "ggx".
template <NamedEnum E>
std::string name_of(E value) {
    for (const auto& row : EnumNames<E>::table)
        if (row.value == value) return std::string(row.name);
    return {};
}

/// Some values with their names, in the order of `values`.
template <NamedEnum E>
std::vector<NamedValue<E>> with_names(std::span<const E> values) {
    std::vector<NamedValue<E>> rows;
    for (const E value : values)
        for (const auto& row : EnumNames<E>::table)
            if (row.value == value) rows.push_back(row);
    return rows;
}
template <NamedEnum E>
std::vector<NamedValue<E>> with_names(std::initializer_list<E> values) {
    return with_names(std::span<const E>(values.begin(), values.size()));
}

/// All names, in the order of the table.
template <NamedEnum E>
std::vector<std::string> names_of() {
    std::vector<std::string> names;
    for (const auto& row : EnumNames<E>::table) names.emplace_back(row.name);
    return names;
}

/// The error for a word that is not one of `accepted`: it says that the word is not `kind` ("a lobe"), and lists the
/// accepted words.
Error unknown_name(std::string_view word, std::string_view kind, std::span<const std::string> accepted);

/// The value of this name. The error lists the accepted names.
template <NamedEnum E>
Result<E> from_name(std::string_view name) {
    for (const auto& row : EnumNames<E>::table)
        if (row.name == name) return row.value;
    return unknown_name(name, EnumNames<E>::kind, names_of<E>());
}

}  // namespace domelight
