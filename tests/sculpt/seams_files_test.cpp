#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <filesystem>

#include "knead/exchange/step_file.hpp"
#include "knead/sculpt/seam_coupling.hpp"
#include "knead/solve/constraint_space.hpp"

namespace knead {
namespace {

TEST(SeamFiles, Explore) {
  const std::filesystem::path directory = std::filesystem::path(KNEAD_SHARED_DIR) / "data/cad";
  if (!std::filesystem::exists(directory)) GTEST_SKIP() << "no CAD files at " << directory;
  for (const auto& entry : std::filesystem::directory_iterator(directory)) {
    if (entry.path().extension() != ".stp" && entry.path().extension() != ".step") continue;
    const auto file = StepFile::read(entry.path());
    if (!file || file->surfaces().empty()) continue;
    std::vector<const Surface*> patches;
    std::vector<int> rows{0};
    for (const StepSurface& s : file->surfaces()) {
      patches.push_back(&s.surface);
      rows.push_back(rows.back() + s.surface.size());
    }
    const double base = suggested_seam_tolerance(patches);
    for (double factor : {0.1, 1.0, 10.0}) {
      const auto begin = std::chrono::steady_clock::now();
      const auto found = find_seams(patches, factor * base);
      const auto middle = std::chrono::steady_clock::now();
      const auto coupled = couple_seams(patches, rows, found->seams);
      const auto end = std::chrono::steady_clock::now();
      int kinds[3] = {}, closed = 0, conts[4] = {}, rigid = 0, restricted = 0;
      double gap = 0;
      for (const Seam& s : found->seams) {
        ++kinds[static_cast<int>(s.kind)];
        closed += s.a.patch == s.b.patch && s.kind == SeamKind::whole;
        if (s.kind == SeamKind::whole) gap = std::max(gap, s.gap);
      }
      for (const auto& r : coupled->reports) {
        ++conts[static_cast<int>(r.continuity)];
        rigid += r.rigid;
        restricted += r.restricted;
      }
      std::printf(
          "%-45s %4zu surfaces tol %8.2g: whole %4d (self %3d) repar %3d partial %4d poles %3zu bad %zu gap %.2g | "
          "none %d c0 %d g1 %d per %d rigid %d restr %d | %.1f ms, %.1f ms\n",
          entry.path().filename().c_str(), patches.size(), factor * base, kinds[0], closed, kinds[1], kinds[2],
          found->collapsed.size(), found->unusable.size(), gap, conts[0], conts[1], conts[2], conts[3], rigid,
          restricted, 1e3 * std::chrono::duration<double>(middle - begin).count(),
          1e3 * std::chrono::duration<double>(end - middle).count());
      if (factor == 1) {
        int k = 0;
        for (const auto& r : coupled->reports)
          if (r.seam.kind == SeamKind::whole && k++ < 6)
            std::printf("    %s-%s rev %d gap %.2g cont %d angle %.2g ratio %.3g dev %.2g mism %.2g: %s\n",
                        to_string(r.seam.a).c_str(), to_string(r.seam.b).c_str(), r.seam.reversed, r.seam.gap,
                        (int)r.continuity, r.angle, r.ratio, r.deviation, r.mismatch, r.reason.c_str());
      }
    }
  }
}

}  // namespace
}  // namespace knead
