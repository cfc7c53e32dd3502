// Scripts without a file: parsed, executed, saved and read again, kept in a snapshot, undone.
#include "exchange/step/file.hpp"
#include "running.hpp"

using namespace knead;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  Session session(Document::fresh("sheet"));
  fuzz::run(session, fuzz::text_of(data, size), 10);
  const std::string snapshot = session.snapshot();
  const auto restored = Session::restore(Document::fresh("sheet"), snapshot);
  fuzz::check(restored.has_value(), "a snapshot cannot be restored");
  fuzz::check(restored->snapshot() == snapshot, "what was restored has another snapshot");
  if (const auto energy = session.energy(); !energy) fuzz::check_error(energy.error());
  if (session.state().surfaces.empty()) return 0;
  const auto saved = session.save();
  if (saved) {
    const auto again = step::File::parse(*saved, "saved.step");
    fuzz::check(again.has_value(), "what was saved cannot be read");
    fuzz::check(again->surfaces().size() == session.state().surfaces.size(),
                "another number of surfaces was saved");
  } else {
    fuzz::check_error(saved.error());
  }
  while (session.can_undo())
    fuzz::check(session.execute(make_command(UndoCommand{})).has_value(), "undo");
  fuzz::check(session.state().surfaces.empty(), "something is left after everything was undone");
  return 0;
}
