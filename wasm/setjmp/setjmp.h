#pragma once
// What WASI's C library lacks: libjpeg and libpng leave damaged files by longjmp. clang lowers it to WebAssembly's exceptions (-mllvm -wasm-enable-sjlj), with the
// functions of setjmp.c.
#ifdef __cplusplus
extern "C" {
#endif

typedef struct {
    void* caller;
    unsigned label;
    struct {
        void* buffer;
        int value;
    } thrown;
} jmp_buf[1];

int setjmp(jmp_buf) __attribute__((__returns_twice__));
void longjmp(jmp_buf, int) __attribute__((__noreturn__));
#define setjmp setjmp

#ifdef __cplusplus
}
#endif
