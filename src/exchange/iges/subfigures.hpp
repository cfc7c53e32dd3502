#pragma once

#include <set>

#include "file.hpp"
#include "knead/brep/model.hpp"

namespace knead::iges {

/// Puts what the definitions of subfigures (308) hold where their instances (408) do: every
/// definition is a part, in its own coordinates, and stands scaled by S and then moved by (X, Y, Z)
/// and by the instance's matrix wherever an instance is, those inside other definitions included.
/// Left out are an instance whose matrix shears, and one whose definition cannot be read. Where
/// there are no instances, nothing changes. Returns the instances that are left out.
std::set<int> add_subfigures(const File& file, brep::Model& model);

}  // namespace knead::iges
