#pragma once

#include <set>
#include <string>

#include "iges_file.hpp"
#include "step_records.hpp"

namespace knead::iges {

/// Writes where subfigure instances (408) put what their definitions (308) hold, as mapped items of representations:
/// every definition is a part, in its own coordinates, and stands scaled by S and then moved by (X, Y, Z) wherever an
/// instance is, those inside other definitions included. An instance with a transformation matrix is left out, for IGES
/// does not say in which order that comes; so is one whose definition cannot be read. Nothing where there are none.
/// \param shown entities that have records under their numbers: faces, and surfaces without faces
/// \param context the name of the context of representations; "$" for none
void add_subfigures(const File& file, const std::set<int>& shown, const std::string& context,
                    step::StepRecords& records);

}  // namespace knead::iges
