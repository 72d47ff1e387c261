#include "c/border.h"

#include "domelight/filtering/prefilter.h"

#include <cmath>

namespace domelight::c {
namespace {

/// No struct will ever be as large. A number above comes from a struct that was not initialised.
constexpr std::size_t k_most_struct_bytes = 1 << 16;

std::string decimal_of(std::size_t number) {
    return std::to_string(number);
}

}  // namespace

Result<void> check_given(std::initializer_list<Given> pointers) {
    for (const Given& given : pointers)
        if (!given.pointer) return Error{"is NULL", field_place(given.name), ""};
    return {};
}

Result<void> check_index(std::size_t index, std::size_t count, const char* name) {
    if (index < count) return {};
    return Error{text(decimal_of(index), " is not below their number, ", decimal_of(count)), field_place(name), ""};
}

Result<void> check_struct_size(std::size_t size, std::size_t least) {
    if (size >= least && size <= k_most_struct_bytes) return {};
    return Error{text(decimal_of(size), " is not from ", decimal_of(least), " to ", decimal_of(k_most_struct_bytes)),
                 field_place("struct_size"), "Fill the struct by its ..._init function, or set struct_size to sizeof."};
}

Result<void> check_unknown_fields(const void* given, std::size_t size, std::size_t known) {
    const auto* bytes = static_cast<const unsigned char*>(given);
    for (std::size_t i = known; i < size; ++i)
        if (bytes[i] != 0)
            return Error{text("byte ", decimal_of(i), " of the struct is set, but this version of the library knows ",
                              decimal_of(known), " bytes"),
                         field_place("struct_size"), "The program needs a newer library."};
    return {};
}

Result<Vec3d> read_direction(const double* d) {
    const Vec3d direction{d[0], d[1], d[2]};
    const double squared = dot(direction, direction);
    if (squared > 0 && std::isfinite(squared)) return direction;
    return Error{text("(", d[0], ", ", d[1], ", ", d[2], ") is not a direction"), field_place("direction"), ""};
}

Result<void> check_threads(int threads) {
    FilterOptions options;
    options.threads = threads;
    return check_filter_options(options);
}

Result<Mat3> read_turn(const double* m) {
    FilterOptions options;
    if (!m) return options.world_to_source;
    for (int i = 0; i < 3; ++i) options.world_to_source.row[i] = {m[3 * i], m[3 * i + 1], m[3 * i + 2]};
    if (auto ok = check_filter_options(options); !ok) return ok.error();
    return options.world_to_source;
}

Progress progress_of(domelight_progress callback, void* data) {
    if (!callback) return nullptr;
    return [callback, data](std::string_view stage, double done) {
        return callback(data, std::string(stage).c_str(), done) == 0;
    };
}

}  // namespace domelight::c
