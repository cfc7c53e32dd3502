#include "knead/exchange/file_io.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "base/large_memory.hpp"

#ifndef __wasi__
#include <poll.h>
#include <sys/file.h>
#endif

namespace knead {
namespace {

std::unexpected<Error> system_error(const std::filesystem::path& path, const std::string& what,
                                    int code, std::string remedy = {}) {
  return std::unexpected(Error{ErrorKind::input,
                               what + ": " + std::strerror(code),
                               {},
                               std::move(remedy),
                               path.string(),
                               0});
}

// A file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (fd_ >= 0) static_cast<void>(::close(fd_));
  }
  [[nodiscard]] int get() const { return fd_; }

 private:
  const int fd_;
};

#ifndef __wasi__

constexpr int longest_wait = 3000;  // milliseconds for somebody to write into a pipe
constexpr int most_links = 40;      // followed one after the other, as by the system
constexpr std::string_view temporary_prefix = ".knead-";

bool write_all(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const auto count = ::write(fd, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

mode_t new_file_mode() {
  const mode_t mask = ::umask(0);
  ::umask(mask);
  return 0666 & ~mask;
}

/// Waits until a pipe, opened without blocking, has something to read or was closed by who wrote
/// into it; false if nobody has opened it for writing in time. From then on it blocks. `bytes` gets
/// what had to be read to find out.
bool wait_for_writer(int fd, std::string& bytes) {
  // Linux reports the end of a pipe only once a writer has come and gone.
  pollfd event{fd, POLLIN, 0};
  int ready = 0;
  do {
    ready = ::poll(&event, 1, longest_wait);
  } while (ready < 0 && errno == EINTR);
  if (ready == 0) {
    // A writer that has not written yet would make a read wait; without one it ends at once.
    char byte = 0;
    const auto count = ::read(fd, &byte, 1);
    if (count == 0 || (count < 0 && errno != EAGAIN)) return false;
    if (count > 0) bytes += byte;
  }
  return ::fcntl(fd, F_SETFL, 0) == 0;
}

/// Where a file written to `path` goes: the end of its links.
Expected<std::filesystem::path> end_of_links(const std::filesystem::path& path) {
  namespace fs = std::filesystem;
  fs::path target = path;
  std::error_code code;
  for (int k = 0; fs::is_symlink(target, code); ++k) {
    if (k == most_links) return system_error(path, "cannot be written", ELOOP, "name a file");
    const fs::path next = fs::read_symlink(target, code);
    if (code) return system_error(path, "cannot be written", code.value());
    target = next.is_absolute() ? next : target.parent_path() / next;
  }
  return target;
}

std::filesystem::path directory_of(const std::filesystem::path& target) {
  return target.has_parent_path() ? target.parent_path() : std::filesystem::path(".");
}

/// Removes the temporary files of processes that were killed: those that nobody has locked.
void remove_leftovers(const std::filesystem::path& directory) {
  namespace fs = std::filesystem;
  std::error_code code;
  for (fs::directory_iterator entry(directory, code), end; !code && entry != end;
       entry.increment(code)) {
    const std::string name = entry->path().filename().string();
    if (!name.starts_with(temporary_prefix) || name.size() != temporary_prefix.size() + 6) continue;
    const Descriptor file(
        ::open(entry->path().c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
    struct stat status {};
    if (file.get() < 0 || ::fstat(file.get(), &status) != 0 || !S_ISREG(status.st_mode)) continue;
    if (::flock(file.get(), LOCK_EX | LOCK_NB) == 0) ::unlink(entry->path().c_str());
  }
}

/// A temporary file in the directory, locked for as long as it is open; `name` is where it is.
/// Below 0: `errno` says why.
int open_temporary(const std::filesystem::path& directory, std::string& name) {
  for (;;) {
    name = (directory / (std::string(temporary_prefix) + "XXXXXX")).string();
    const int fd = ::mkostemp(name.data(), O_CLOEXEC);
    if (fd < 0) return fd;
    // Without locks (some network file systems) nothing is taken for a leftover either.
    struct stat status {};
    static_cast<void>(::flock(fd, LOCK_EX));
    if (::fstat(fd, &status) == 0 && status.st_nlink > 0) return fd;
    static_cast<void>(::close(fd));  // another process took it for a leftover before it was locked
  }
}

#endif

}  // namespace

Expected<std::string> read_file(const std::filesystem::path& path, std::size_t most) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.get() < 0) return system_error(path, "cannot be opened", errno, "check the path");
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) return system_error(path, "cannot be read", errno);
  if (S_ISDIR(status.st_mode)) return system_error(path, "cannot be read", EISDIR, "name a file");
  const auto too_large = [&] {
    return std::unexpected(Error{ErrorKind::input,
                                 fmt::format("the file has more than {} MiB", most >> 20U),
                                 {},
                                 "use a smaller file",
                                 path.string(),
                                 0});
  };
  std::size_t expected = 0;
  if (S_ISREG(status.st_mode)) {
    if (static_cast<unsigned long long>(status.st_size) > most) return too_large();
    expected = static_cast<std::size_t>(status.st_size);
  }
  // One byte more than the file has shows that it ends there, without room for what it might have
  // grown by.
  std::string bytes;
  detail::reserve_large(bytes, expected + 1);
  bytes.resize(expected + 1);
  std::size_t filled = 0;
#ifndef __wasi__
  if (S_ISFIFO(status.st_mode)) bytes.clear();
  if (S_ISFIFO(status.st_mode) && !wait_for_writer(file.get(), bytes)) {
    return std::unexpected(Error{
        ErrorKind::input, "nothing writes into this pipe", {}, "name a file", path.string(), 0});
  }
  if (!S_ISREG(status.st_mode)) static_cast<void>(::fcntl(file.get(), F_SETFL, 0));
  if (S_ISFIFO(status.st_mode)) filled = bytes.size();
#endif
  for (;;) {
    if (filled == bytes.size())
      bytes.resize(bytes.size() + std::max<std::size_t>(65536, bytes.size() / 2));
    const auto count = ::read(file.get(), bytes.data() + filled, bytes.size() - filled);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return system_error(path, "cannot be read", errno);
    if (count == 0) break;
    filled += static_cast<std::size_t>(count);
    if (filled > most) return too_large();
  }
  bytes.resize(filled);
  return bytes;
}

#ifdef __wasi__

// A browser stores its files by other means.
Expected<void> check_writable(const std::filesystem::path& path) {
  return system_error(path, "cannot be written", ENOTSUP, "take the bytes and store them yourself");
}
Expected<void> write_file_atomically(const std::filesystem::path& path, std::string_view) {
  return check_writable(path);
}

#else

Expected<void> check_writable(const std::filesystem::path& path) {
  const auto target = end_of_links(path);
  if (!target) return std::unexpected(target.error());
  struct stat status {};
  if (::stat(target->c_str(), &status) == 0) {
    if (S_ISDIR(status.st_mode))
      return system_error(path, "cannot be written", EISDIR, "name a file");
    if (!S_ISREG(status.st_mode)) return {};
    // Renaming needs no right to the file that goes away, but who protects a file means it.
    if ((status.st_mode & 0222U) == 0 || ::access(target->c_str(), W_OK) != 0) {
      return system_error(path, "the file may not be written to", EACCES,
                          "name another one, or change its permissions");
    }
  }
  if (::access(directory_of(*target).c_str(), W_OK | X_OK) != 0) {
    return system_error(path, "cannot be written", errno,
                        "check that its directory exists and may be written to");
  }
  return {};
}

Expected<void> write_file_atomically(const std::filesystem::path& path, std::string_view bytes) {
  if (auto possible = check_writable(path); !possible) return possible;
  const auto target = end_of_links(path);
  if (!target) return std::unexpected(target.error());
  struct stat status {};
  const bool exists = ::stat(target->c_str(), &status) == 0;
  if (exists && !S_ISREG(status.st_mode)) {
    // A device or pipe (/dev/stdout) cannot be renamed over.
    const Descriptor sink(::open(target->c_str(), O_WRONLY | O_CLOEXEC));
    if (sink.get() < 0 || !write_all(sink.get(), bytes))
      return system_error(path, "cannot be written", errno);
    return {};
  }
  const auto directory = directory_of(*target);
  remove_leftovers(directory);
  std::string temporary;
  const Descriptor file(open_temporary(directory, temporary));
  if (file.get() < 0) return system_error(path, "cannot be written", errno);
  if (!write_all(file.get(), bytes) ||
      ::fchmod(file.get(), exists ? status.st_mode & 07777U : new_file_mode()) != 0 ||
      ::fsync(file.get()) != 0 || ::rename(temporary.c_str(), target->c_str()) != 0) {
    const int reason = errno;
    ::unlink(temporary.c_str());
    return system_error(path, "cannot be written", reason);
  }
  // The rename itself is made durable; on a file system that cannot do so it has still happened.
  const Descriptor parent(::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (parent.get() >= 0) static_cast<void>(::fsync(parent.get()));
  return {};
}

#endif

}  // namespace knead
