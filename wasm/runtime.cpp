// What the module has in place of a runtime library that its sources mention and that WebAssembly lacks.

#include <cstddef>
#include <cstdlib>

extern "C" {

// `throw` is compiled to these calls. Only memory that cannot be had is thrown here; the trap reaches JavaScript, which
// reports it and abandons the instance.
void* __cxa_allocate_exception(std::size_t) noexcept {
    std::abort();
}
void __cxa_throw(void*, void*, void (*)(void*)) {
    std::abort();
}

// The module never ends, so nothing of its one thread is destroyed.
int __cxa_thread_atexit(void (*)(void*), void*, void*) noexcept {
    return 0;
}

}  // extern "C"
