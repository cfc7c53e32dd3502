#include "run_script.hpp"

#include <fmt/format.h>

#include "knead/exchange/file_io.hpp"
#include "knead/session/command_json.hpp"

namespace knead::examples {

Expected<Session> run_script(const std::string& script, const std::string& file) {
  const auto text = read_file(script);
  if (!text) return std::unexpected(text.error());
  const auto commands = parse_script(*text, script);
  if (!commands) return std::unexpected(commands.error());
  auto document = file.empty() ? Document::fresh("sheet") : Document::open(file);
  if (!document) return std::unexpected(document.error());
  Session session(std::move(*document));
  for (std::size_t k = 0; k < commands->size(); ++k) {
    if (auto status = session.execute((*commands)[k]); !status) {
      return std::unexpected(status.error().within(fmt::format("commands[{}]", k)));
    }
  }
  return session;
}

}  // namespace knead::examples
