#pragma once
// The border between C and the library: errors, structs that know their size, words. Nothing that is thrown crosses it.

#include "domelight/base/names.h"
#include "domelight/base/progress.h"
#include "domelight/base/result.h"
#include "domelight/base/vec.h"
#include "domelight/domelight_c.h"

#include "base/field_place.h"
#include "base/text.h"

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <exception>
#include <initializer_list>
#include <new>
#include <optional>
#include <string>
#include <utility>

namespace domelight::c {

/// An error for the caller, who frees it. Where there is no memory for it, the result is out_of_memory().
domelight_error* make_error(const Error& error) noexcept;
domelight_error* make_error(const char* what) noexcept;
/// The error that says so. It takes no memory, and freeing it does nothing.
domelight_error* out_of_memory() noexcept;

/// Runs the body of a function of the interface, which returns a Result<void>. Everything that it throws becomes an
/// error; a build without exceptions (WebAssembly) has nothing to catch.
template <typename Body>
domelight_error* guarded(Body&& body) noexcept {
#if defined(__cpp_exceptions)
    try {
#endif
        const Result<void> done = body();
        return done ? nullptr : make_error(done.error());
#if defined(__cpp_exceptions)
    } catch (const std::bad_alloc&) {
        return out_of_memory();
    } catch (const std::exception& failure) {
        return make_error(failure.what());
    } catch (...) {
        return make_error("failed for an unknown reason");
    }
#endif
}

/// A pointer that the caller gave, with its name.
struct Given {
    const void* pointer;
    const char* name;
};
/// An error that names the first pointer that is null.
Result<void> check_given(std::initializer_list<Given> pointers);

/// An error unless `index`, which the caller gave as `name`, is below `count`.
Result<void> check_index(std::size_t index, std::size_t count, const char* name);

/// A handle that is made for the caller. Precondition: `place` is not null.
template <typename Handle, typename... Parts>
Result<void> hand_out(Handle** place, Parts&&... parts) {
    *place = new Handle{std::forward<Parts>(parts)...};
    return {};
}

/// The size of a struct in the first version of the interface: the least that a caller may have. When a struct gets
/// another field, its line here states the size that it had.
template <typename T>
inline constexpr std::size_t k_first_size = sizeof(T);

/// An error unless a struct of this size can be read or written. `least`: k_first_size. `most`: our own size.
Result<void> check_struct_size(std::size_t size, std::size_t least);
/// An error if a struct of a newer interface has fields that are set and that this library does not know.
Result<void> check_unknown_fields(const void* given, std::size_t size, std::size_t known);

/// The caller's struct; fields that it lacks are as in `defaults`.
template <typename T>
Result<T> read_struct(const T* given, const T& defaults) {
    if (!given) return defaults;
    if (auto ok = check_struct_size(given->struct_size, k_first_size<T>); !ok) return ok.error();
    if (auto ok = check_unknown_fields(given, given->struct_size, sizeof(T)); !ok) return ok.error();
    T known = defaults;
    std::memcpy(&known, given, std::min(given->struct_size, sizeof(T)));
    return known;
}

/// Element `index` of a caller's array, whose elements lie as far apart as the first one's struct_size says.
template <typename T>
const T* element(const T* array, std::size_t index) {
    return reinterpret_cast<const T*>(reinterpret_cast<const unsigned char*>(array) + index * array->struct_size);
}

/// Fills in the fields that the caller's struct has; what else it has becomes 0.
template <typename T>
Result<void> write_struct(T* place, const T& value) {
    const std::size_t size = place->struct_size;
    if (auto ok = check_struct_size(size, k_first_size<T>); !ok) return ok;
    std::memset(static_cast<void*>(place), 0, size);
    std::memcpy(static_cast<void*>(place), &value, std::min(size, sizeof(T)));
    place->struct_size = size;
    return {};
}

/// The body of the functions ..._init_sized.
template <typename T>
void init_struct(T* place, std::size_t size, const T& defaults) {
    if (!place || size < sizeof(std::size_t)) return;
    std::memset(static_cast<void*>(place), 0, size);
    std::memcpy(static_cast<void*>(place), &defaults, std::min(size, sizeof(T)));
    place->struct_size = size;
}

/// The value of the word that the caller gave for the field `name`, or `otherwise` if there is none.
template <NamedEnum E>
Result<E> read_word(const char* word, E otherwise, const char* name) {
    if (!word) return otherwise;
    const auto value = from_name<E>(word);
    if (!value) return value.error().at(field_place(name));
    return value;
}

/// Sets `field` to the value of the word, if the caller gave one.
template <NamedEnum E>
Result<void> read_choice(const char* word, E& field, const char* name) {
    const auto value = read_word(word, field, name);
    if (!value) return value.error();
    field = *value;
    return {};
}
template <NamedEnum E>
Result<void> read_optional(const char* word, std::optional<E>& field, const char* name) {
    if (!word) return {};
    field.emplace();
    return read_choice(word, *field, name);
}

inline std::string text_or(const char* given, const char* otherwise) {
    return given ? given : otherwise;
}

/// A direction of three numbers. Errors: it is 0, or not finite.
Result<Vec3d> read_direction(const double* direction);

/// An error unless `threads` is from 0 to 1024.
Result<void> check_threads(int threads);

/// A matrix of nine numbers by rows; null is the identity. Errors: it is not orthogonal.
Result<Mat3> read_turn(const double* world_to_source);

/// The caller's callback as the library calls it; null where there is none.
Progress progress_of(domelight_progress callback, void* data);

}  // namespace domelight::c
