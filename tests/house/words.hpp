#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace knead::house {

/// Turns of phrase that words.cpp bans, with what to write instead, in the pages below `root`
/// (those beside README.md, docs, examples), the Makefile and the texts of the sources: what stands
/// between quotes in include, src, apps, bindings, web/src and scripts. One line each, "path:
/// "turn": write …"; empty where there are none.
[[nodiscard]] std::vector<std::string> banned_turns(const std::filesystem::path& root);

}  // namespace knead::house
