#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "knead/base/error.hpp"
#include "knead/session/session.hpp"

namespace knead::cli {

/// A file named on the command line: the option, and the path as given (empty: not given).
struct NamedFile {
  std::string option, path;
};

/// Checks before the work begins whether the results can be written. Errors: an output that is the
/// same file as another output or as one of `inputs` (usage); a directory that is missing or not
/// writable (input). Devices and pipes are always assumed writable, and different from one another.
[[nodiscard]] Expected<void> check_outputs(const std::vector<NamedFile>& outputs,
                                           const std::vector<NamedFile>& inputs);

/// A new file of the faces of a session as they are now. Warns of what it leaves out.
[[nodiscard]] Expected<std::string> bytes_of_faces(const Session& session, const Format& format,
                                                   const SaveOptions& how);

/// A usage error where `path` has another ending than `ending`: its name would promise what is not
/// written. A name without an ending, and a device, promise nothing.
[[nodiscard]] Expected<void> check_name(const NamedFile& output, std::string_view ending,
                                        std::string_view content);

/// `write_file_atomically`, remembered: an error that comes later says that this one is written.
[[nodiscard]] Expected<void> write_output(const std::string& path, std::string_view bytes);

/// Checks before the work begins whether files can be written into a directory, which may have to
/// be made. Errors (input): it is a file; it may not be written to, or cannot be made.
[[nodiscard]] Expected<void> check_directory(const NamedFile& directory);

/// Puts files, names with bytes, into a directory, which is made where it is missing: by way of one
/// within it, so that they come together or, unless the system fails between two renames, none
/// does. Other files there stay. Remembered as by `write_output`. Errors (input): what the system
/// says.
[[nodiscard]] Expected<void> write_together(
    const NamedFile& directory, const std::vector<std::pair<std::string, std::string>>& files);

/// The files that `write_output` has written so far: "a.json, b.step".
[[nodiscard]] const std::string& written_outputs();

}  // namespace knead::cli
