// Damaged snapshots whose checksum is right, which is no secret. What is restored can be saved, and
// goes on.
#include <cstring>

#include "running.hpp"

using namespace knead;

namespace {

/// That of snapshots, snapshot.cpp.
std::uint64_t checksum(std::string_view bytes) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (std::size_t k = 0; k < bytes.size(); k += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + k, std::min<std::size_t>(8, bytes.size() - k));
    hash = (hash ^ word) * 0x100000001b3U;
  }
  return hash ^ bytes.size();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view content = fuzz::text_of(data, size);
  std::string bytes = "Knead snapshot e\n";
  const std::uint64_t sum = checksum(content);
  bytes.append(reinterpret_cast<const char*>(&sum), sizeof sum);
  bytes += content;
  auto session = Session::restore(Document::fresh("sheet"), bytes);
  if (!session) {
    fuzz::check_error(session.error());
    return 0;
  }
  fuzz::check_state(*session);
  if (fuzz::control_points(*session) > 300) return 0;
  static_cast<void>(session->journal());
  if (const auto energy = session->energy(); !energy) fuzz::check_error(energy.error());
  for (std::size_t k = 0; k < session->state().surfaces.size(); ++k) {
    static_cast<void>(session->largest_displacement(static_cast<int>(k)));
    static_cast<void>(session->moved_control_points(static_cast<int>(k)));
  }
  fuzz::run(*session,
            R"({"knead": 2, "commands": [{"do": "step"}, {"do": "refine"}, {"do": "step"}]})", 3);
  while (session->can_undo())
    fuzz::check(session->execute(make_command(UndoCommand{})).has_value(), "undo");
  if (const auto saved = session->save(); !saved) fuzz::check_error(saved.error());
  return 0;
}
