#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace knead::house {

/// Everything in the source tree at `root` that breaks a rule of the house, one line each,
/// "path:line: what is wrong"; empty where all is well. The rules:
///  - every directory of include/knead and src is a room, and holds a room's files only;
///  - a room includes itself and rooms below it in the list (base first), public headers as
///  "knead/ROOM/x.hpp" and
///    internals as "ROOM/x.hpp" alike, nothing of the programs on top of it, and quoted includes
///    name a file that exists;
///  - a public header includes no internal one, and neither do apps/knead and the examples; there
///  are no more public
///    headers than rules.cpp says;
///  - x.cpp includes its own header first, so that every header with a source is compiled on its
///  own;
///  - file formats are named in their folders of src/exchange alone;
///  - the folders of src/brep and src/exchange hold 40 source files at most;
///  - docs/api.md lists every public header once, and nothing else;
///  - headers begin with #pragma once;
///  - the core neither throws nor catches, but for the one file that rules.cpp names;
///  - no function of the numerical rooms is longer than 70 lines, with the exceptions that
///  rules.cpp lists and argues;
///  - no source file is longer than 400 lines.
[[nodiscard]] std::vector<std::string> violations(const std::filesystem::path& root);

}  // namespace knead::house
