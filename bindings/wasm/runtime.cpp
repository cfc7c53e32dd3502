// Symbols that Debian's WebAssembly libraries expect and nothing provides: they are compiled with
// stack protection, which the sandbox does not need.
#include <cstdint>

extern "C" {
std::uintptr_t __stack_chk_guard = 0x5afe57ac;
[[noreturn]] void __stack_chk_fail() { __builtin_trap(); }
}
