// What Debian's libraries for WebAssembly expect of a program and nobody there provides: they are compiled with stack
// protection, which the sandbox has no need of.
#include <cstdint>

extern "C" {
std::uintptr_t __stack_chk_guard = 0x5afe57ac;
[[noreturn]] void __stack_chk_fail() { __builtin_trap(); }
}
