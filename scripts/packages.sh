# Debian packages and what needs them. Sourced by scripts/build.sh; nothing else names a package.

# Compiling the library and the program.
build_packages=(
    g++ cmake ninja-build pkg-config
    libopenexr-dev      # .exr; brings zlib
    libimath-dev        # half floats
    libpng-dev libjpeg62-turbo-dev
    liblcms2-dev        # ICC profiles of pictures
    libhwy-dev          # SIMD chosen at run time
    libzstd-dev         # KTX2 supercompression
    libdraco-dev libmeshoptimizer-dev  # compressed glTF
    libwebp-dev         # WebP textures, animations
    libastcenc-dev      # ASTC HDR
    libssl-dev          # SHA-256 (libcrypto only)
    libembree-dev       # rays; brings oneTBB
    libcpp-httplib-dev  # the page of `domelight view`
    libfmt-dev nlohmann-json3-dev libcli11-dev
)
# ./test: the test framework, the benchmarks, and the scripts that drive the program.
test_packages=("${build_packages[@]}" doctest-dev libbenchmark-dev python3
    glslang-tools       # compiles docs/shaders
    valgrind            # tests/c: leaks of the C interface
    man-db)             # tests/install: sets the manual pages
# ./test --fuzz: libFuzzer comes with clang.
fuzz_packages=("${test_packages[@]}" clang-19 libclang-rt-19-dev)
# tests/engines/browser: the browser that runs the engines, Node to drive it, and OpenEXR's own tools.
engine_packages=(chromium nodejs npm openexr)
# web/ and tests/web: what builds the browser app, and the browser that runs it.
web_packages=(chromium nodejs npm)
# The WebAssembly module (cmake --preset wasm) and the npm package: Debian has the C library of WASI, and libc++ compiled for it.
wasm_packages=(clang-22 lld-22 wasi-libc libc++-22-dev-wasm32 libclang-rt-22-dev-wasm32 binaryen libhwy-dev libfmt-dev libimath-dev nlohmann-json3-dev dpkg-dev cmake ninja-build python3-pip)
# The command that each of them brings, where its name differs.
declare -A command_of=([nodejs]=node [openexr]=exrheader)
# tests/python: the headers of Python, and its virtual environments.
python_packages=(python3-dev python3-venv)
# ./test --package: a root of Debian with nothing in it.
package_packages=(mmdebstrap)
# ./test --slurm starts a cluster of two nodes on this machine
slurm_packages=(slurm-wlm munge)
# bench/peers.py: the program that is measured beside ours.
peer_packages=(libfilament-tools)
