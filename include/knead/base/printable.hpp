#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace knead {

/// Text from a file or a script, fit for one line of a terminal: control characters (C0, DEL and
/// C1, so line breaks and escape sequences) and bytes that are not UTF-8 become "\n", "\t", "\r" or
/// "\xNN"; all else is unchanged.
///
/// \param most bytes at most, of which long texts keep the first three quarters and the last
/// quarter, cut between
///        characters, with "…" in between; at least 16
///
/// Cost: O(most), after one look at the length.
[[nodiscard]] std::string printable(std::string_view text, std::size_t most = 200);

/// Text as XML 1.0 may have it between tags and in attributes: "&", "<", ">" and quotation marks as
/// entities, control characters (C0) as spaces.
[[nodiscard]] std::string xml_text(std::string_view text);

}  // namespace knead
