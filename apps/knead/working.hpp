#pragma once

#include <string>

namespace knead::cli {

/// Where the program is in its work, for what ends it without a value: "script.json: commands[3]".
void work_on(std::string place);
[[nodiscard]] const std::string& place_of_work();

}  // namespace knead::cli
