#include "notes.hpp"

#include <algorithm>
#include <utility>

namespace knead {

void note_once(SessionRecord& record, Note note) {
  if (std::ranges::find(record.notes, note) == record.notes.end())
    record.notes.push_back(std::move(note));
}

void note_last(SessionRecord& record, std::string_view begins, const std::string& note,
               Diagnostic read) {
  std::erase_if(record.notes, [&](const std::string& n) { return n.starts_with(begins); });
  record.notes.emplace_back(std::string(begins) + note, std::move(read));
}

}  // namespace knead
