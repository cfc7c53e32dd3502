# Toolchain file: WebAssembly with 128-bit SIMD and without exceptions, by Debian's clang 19, lld, libc++ and wasi-libc.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR wasm32)
set(CMAKE_CXX_COMPILER clang++-19)
set(CMAKE_CXX_COMPILER_TARGET wasm32-wasi)
# Any archiver will do: wasm-ld needs no index of symbols.
set(CMAKE_AR ar)
set(CMAKE_RANLIB ranlib)

set(CMAKE_CXX_FLAGS_INIT "-msimd128 -fno-exceptions")
# The stack lies below the data, so that an overflow traps instead of overwriting it.
set(CMAKE_EXE_LINKER_FLAGS_INIT "-Wl,-z,stack-size=1048576 -Wl,--stack-first")

# Programs of this machine, nothing else of it.
set(CMAKE_FIND_ROOT_PATH /usr/lib/wasm32-wasi)
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
