#include "knead/exchange/file_io.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>

namespace knead {
namespace {

std::unexpected<Error> system_error(const std::filesystem::path& path, const std::string& what, int code,
                                    std::string remedy = {}) {
  return std::unexpected(
      Error{ErrorKind::input, what + ": " + std::strerror(code), {}, std::move(remedy), path.string(), 0});
}

// A file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { close(); }
  [[nodiscard]] int get() const { return fd_; }
  int close() {
    const int result = fd_ < 0 ? 0 : ::close(fd_);
    fd_ = -1;
    return result;
  }

 private:
  int fd_;
};

[[maybe_unused]] bool write_all(int fd, std::string_view bytes) {
  while (!bytes.empty()) {
    const auto count = ::write(fd, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

#ifndef __wasi__
mode_t new_file_mode() {
  const mode_t mask = ::umask(0);
  ::umask(mask);
  return 0666 & ~mask;
}
#endif

}  // namespace

Expected<std::string> read_file(const std::filesystem::path& path) {
  Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.get() < 0) return system_error(path, "cannot be opened", errno, "check the path");
  struct stat status {};
  if (::fstat(file.get(), &status) != 0) return system_error(path, "cannot be read", errno);
  if (S_ISDIR(status.st_mode)) return system_error(path, "cannot be read", EISDIR, "name a file");
  std::string bytes(S_ISREG(status.st_mode) ? static_cast<std::size_t>(status.st_size) : 0, '\0');
  std::size_t filled = 0;
  for (;;) {
    if (filled == bytes.size()) bytes.resize(bytes.size() + 65536);
    const auto count = ::read(file.get(), bytes.data() + filled, bytes.size() - filled);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return system_error(path, "cannot be read", errno);
    if (count == 0) break;
    filled += static_cast<std::size_t>(count);
  }
  bytes.resize(filled);
  return bytes;
}

#ifdef __wasi__

// A browser stores its files by other means.
Expected<void> write_file_atomically(const std::filesystem::path& path, std::string_view) {
  return system_error(path, "cannot be written", ENOTSUP, "take the bytes and store them yourself");
}

#else

Expected<void> write_file_atomically(const std::filesystem::path& path, std::string_view bytes) {
  namespace fs = std::filesystem;
  std::error_code code;
  // A link is written through, not replaced by a file.
  fs::path target = path;
  if (fs::is_symlink(path, code)) {
    target = fs::weakly_canonical(path, code);
    if (code) return system_error(path, "cannot be written", code.value());
  }
  struct stat status {};
  const bool exists = ::stat(target.c_str(), &status) == 0;
  if (exists && S_ISDIR(status.st_mode)) return system_error(path, "cannot be written", EISDIR, "name a file");
  if (exists && !S_ISREG(status.st_mode)) {
    // A device or pipe (/dev/stdout) cannot be renamed over.
    Descriptor sink(::open(target.c_str(), O_WRONLY | O_CLOEXEC));
    if (sink.get() < 0 || !write_all(sink.get(), bytes)) return system_error(path, "cannot be written", errno);
    return {};
  }
  auto directory = target.parent_path();
  if (directory.empty()) directory = ".";
  std::string temporary = (directory / ("." + target.filename().string() + ".XXXXXX")).string();
  Descriptor file(::mkostemp(temporary.data(), O_CLOEXEC));
  if (file.get() < 0) {
    return system_error(path, "cannot be written", errno, "check that its directory exists and may be written to");
  }
  const auto give_up = [&](int reason) {
    file.close();
    ::unlink(temporary.c_str());
    return system_error(path, "cannot be written", reason);
  };
  if (!write_all(file.get(), bytes)) return give_up(errno);
  if (::fchmod(file.get(), exists ? status.st_mode & 07777 : new_file_mode()) != 0) return give_up(errno);
  if (::fsync(file.get()) != 0) return give_up(errno);
  if (file.close() != 0) return give_up(errno);
  if (::rename(temporary.c_str(), target.c_str()) != 0) return give_up(errno);
  // The rename itself is made durable; on a file system that cannot do so it has still happened.
  Descriptor parent(::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (parent.get() >= 0) static_cast<void>(::fsync(parent.get()));
  return {};
}

#endif

}  // namespace knead
