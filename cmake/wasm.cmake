# Toolchain: Domelight for WebAssembly, by Debian's clang 22, wasi-libc and libc++ (scripts/packages.sh, wasm_packages). One thread, 128-bit SIMD.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR wasm32)
set(DOMELIGHT_WASM ON)

find_program(CMAKE_C_COMPILER NAMES clang-22 clang REQUIRED)
find_program(CMAKE_CXX_COMPILER NAMES clang++-22 clang++ REQUIRED)
set(CMAKE_C_COMPILER_TARGET wasm32-wasi)
set(CMAKE_CXX_COMPILER_TARGET wasm32-wasi)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(CMAKE_EXECUTABLE_SUFFIX .wasm)

# `throw` ends the module with a trap, and nothing is caught: that is what -fignore-exceptions means. What depends on outside input returns a Result
# and throws nothing; only memory that cannot be had is thrown.
set(CMAKE_C_FLAGS_INIT "-msimd128 -Wno-deprecated")
set(CMAKE_CXX_FLAGS_INIT "-msimd128 -Wno-deprecated -stdlib=libc++ -fexceptions -fignore-exceptions -DDOMELIGHT_ONE_THREAD")
