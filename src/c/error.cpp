#include "domelight/base/version.h"

#include "c/border.h"

struct domelight_error {
    domelight::Error error;
    std::string text;
};

namespace domelight::c {
namespace {

/// Its address is the error for which there is no memory; nothing is ever read from it.
char g_out_of_memory;

/// Makes an error from what `make` returns, an Error.
template <typename Make>
domelight_error* new_error(const Make& make) noexcept {
#if defined(__cpp_exceptions)
    try {
#endif
        Error error = make();
        std::string text = error.format();
        return new domelight_error{std::move(error), std::move(text)};
#if defined(__cpp_exceptions)
    } catch (...) {
        return out_of_memory();
    }
#endif
}

}  // namespace

domelight_error* out_of_memory() noexcept {
    return reinterpret_cast<domelight_error*>(&g_out_of_memory);
}

domelight_error* make_error(const Error& error) noexcept {
    return new_error([&] { return error; });
}

domelight_error* make_error(const char* what) noexcept {
    return new_error([&] { return Error{what, "", ""}; });
}

}  // namespace domelight::c

using namespace domelight;

namespace {

constexpr const char* k_no_memory = "out of memory";

bool is_object(const domelight_error* error) {
    return error && error != c::out_of_memory();
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
