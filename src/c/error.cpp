#include "domelight/base/version.h"

#include "c/border.h"

struct domelight_error {
    domelight::Error error;
    std::string text;
};

namespace domelight::c {
namespace {

/// Stands for the error that there is no memory for.
char no_memory_left;

domelight_error* no_memory() {
    return reinterpret_cast<domelight_error*>(&no_memory_left);
}

}  // namespace

domelight_error* out_of_memory() noexcept {
    return no_memory();
}

domelight_error* make_error(const Error& error) noexcept {
#if defined(__cpp_exceptions)
    try {
        return new domelight_error{error, error.format()};
    } catch (...) {
        return no_memory();
    }
#else
    return new domelight_error{error, error.format()};
#endif
}

}  // namespace domelight::c

using namespace domelight;

namespace {

constexpr const char* k_no_memory = "out of memory";

bool is_object(const domelight_error* error) {
    return error && error != c::no_memory();
}

}  // namespace

extern "C" {

const char* domelight_error_message(const domelight_error* error) {
    return is_object(error) ? error->error.what.c_str() : error ? k_no_memory : "";
}

const char* domelight_error_where(const domelight_error* error) {
    return is_object(error) ? error->error.where.c_str() : "";
}

const char* domelight_error_hint(const domelight_error* error) {
    return is_object(error) ? error->error.hint.c_str() : "";
}

const char* domelight_error_text(const domelight_error* error) {
    return is_object(error) ? error->text.c_str() : error ? k_no_memory : "";
}

int32_t domelight_error_is_cancelled(const domelight_error* error) {
    return is_object(error) && error->error.what == "cancelled" && error->error.where.empty();
}

void domelight_error_free(domelight_error* error) {
    if (is_object(error)) delete error;
}

int32_t domelight_c_abi_version(void) {
    return DOMELIGHT_C_ABI_VERSION;
}

const char* domelight_version(void) {
    return version();
}

}  // extern "C"
