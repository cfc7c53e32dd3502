#pragma once

namespace knead {

/// How many threads a call of the library may use at most, itself included. Results are the same
/// bits with any number. 0, the default: as many as the environment variable KNEAD_THREADS says
/// when it is first asked for, or else one for every processor that this process may run on. One in
/// WebAssembly, whatever is asked for. Threads start when they are first needed, wait between
/// calls, and end with the process; where the system grants fewer, fewer do the work. May be called
/// at any time; calls that run already keep their number.
void set_thread_count(int count);

/// The number in force, from 1 to `max_thread_count`.
[[nodiscard]] int thread_count();

inline constexpr int max_thread_count = 256;

}  // namespace knead
