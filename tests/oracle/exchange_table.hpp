#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace knead::oracle {

/// The table in docs/exchange.md: a row per file and hold.
[[nodiscard]] std::filesystem::path exchange_page();

/// "| file | held | …": how a row begins.
[[nodiscard]] std::string key_of(const std::string& file, const std::string& held);

/// The row of the page that begins with a key.
[[nodiscard]] std::optional<std::string> row_of_page(const std::string& key);

/// Puts a row in the place of the one with its key, or behind the last one. Nothing where the page
/// is not there.
void put_row(const std::string& key, const std::string& row);

/// Two digits; what is below `least`, which differs from one machine to the next, as "< least".
[[nodiscard]] std::string figure(double value, double least);

}  // namespace knead::oracle
