// The functions that clang calls for setjmp and longjmp (llvm/lib/Target/WebAssembly/WebAssemblyLowerEmscriptenEHSjLj.cpp).
#include "setjmp.h"

#include <stdint.h>

__asm__(".tagtype __c_longjmp i32\n"
        ".globl __c_longjmp\n"
        "__c_longjmp:\n");

/// Notes the place of a call of setjmp: which call of the function around it, and which of that function's calls of setjmp.
void __wasm_setjmp(jmp_buf buffer, uint32_t label, void* caller) {
    buffer->caller = caller;
    buffer->label = label;
}

/// The label, if the place is in this call of the function; 0: in one of its callers.
uint32_t __wasm_setjmp_test(jmp_buf buffer, void* caller) {
    return buffer->caller == caller ? buffer->label : 0;
}

void __wasm_longjmp(jmp_buf buffer, int value) {
    buffer->thrown.buffer = buffer;
    buffer->thrown.value = value ? value : 1;
    __builtin_wasm_throw(1, &buffer->thrown);
}
