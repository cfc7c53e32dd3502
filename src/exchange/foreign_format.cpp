#include "foreign_format.hpp"

#include <fmt/format.h>

#include <cctype>
#include <cstdint>
#include <cstring>

namespace knead::detail {
namespace {

using namespace std::string_view_literals;

constexpr std::size_t head_size = 4096;  // bytes that are looked at

bool is_digit(char c) { return '0' <= c && c <= '9'; }

bool is_text_stl(std::string_view head) {
  return head.starts_with("solid") && head.find("facet normal") != head.npos;
}

/// 80 bytes, the number of triangles, and 50 bytes for each.
bool is_binary_stl(std::string_view bytes) {
  if (bytes.size() < 84) return false;
  std::uint64_t count = 0;
  for (std::size_t k = 0; k < 4; ++k)
    count += std::uint64_t{static_cast<unsigned char>(bytes[80 + k])} << (8 * k);
  return count > 0 && bytes.size() == 84 + 50 * count;
}

/// Scripts and documents of Knead; the latter have a name or a source.
bool is_script(std::string_view head) {
  return head.starts_with("{") && head.find("\"knead\"") != head.npos;
}
bool is_document(std::string_view head) {
  return is_script(head) &&
         (head.find("\"name\"") != head.npos || head.find("\"source\"") != head.npos);
}

bool is_gltf(std::string_view head) {
  return head.starts_with("glTF") ||
         (head.starts_with("{") && head.find("\"asset\"") != head.npos &&
          head.find("\"version\"") != head.npos);
}

/// IGES 5.3, § 2.2.4.2.
bool is_iges_head(std::string_view head) {
  if (head.size() < 80 || (head[72] != 'S' && head[72] != 'C' && head[72] != 'B')) return false;
  for (const char c : head.substr(73, 7)) {
    if (c != ' ' && !is_digit(c)) return false;
  }
  return is_digit(head[79]);
}

struct Known {
  std::string_view name;
  bool (*recognised)(std::string_view head);
};

// Those whose beginning decides come first.
constexpr Known cad_formats[] = {
    {"an IGES file", is_iges_head},
    {"a Rhino file (.3dm)",
     [](std::string_view head) { return head.starts_with("3D Geometry File Format"); }},
    {"an Open CASCADE file (.brep)",
     [](std::string_view head) {
       return head.starts_with("DBRep_DrawableShape") ||
              head.find("CASCADE Topology V") != head.npos ||
              head.find("Open CASCADE Topology") != head.npos;
     }},
    {"a Parasolid file",
     [](std::string_view head) {
       return head.starts_with("**ABCDEFGHIJKLMNOPQRSTUVWXYZ") || head.starts_with("PS\0\0"sv) ||
              head.find("SCH_SCHEMA") != head.npos || head.find("TRANSMIT FILE") != head.npos;
     }},
    {"a CATIA file",
     [](std::string_view head) {
       return head.starts_with("V5_CFV2") || head.starts_with("V4_CFV2");
     }},
    {"a SolidWorks file, or another one in OLE format",
     [](std::string_view head) { return head.starts_with("\xD0\xCF\x11\xE0\xA1\xB1\x1A\xE1"); }},
    {"a STEP file in XML",
     [](std::string_view head) {
       return head.starts_with("<?xml") && head.find("10303") != head.npos;
     }},
};

constexpr Known mesh_formats[] = {
    {"an STL file", is_text_stl},
    {"a glTF file", is_gltf},
    {"a PLY file",
     [](std::string_view head) { return head.starts_with("ply\n") || head.starts_with("ply\r"); }},
};

constexpr Known packed_formats[] = {
    {"a ZIP archive", [](std::string_view head) { return head.starts_with("PK\x03\x04"); }},
    {"compressed by gzip", [](std::string_view head) { return head.starts_with("\x1F\x8B"); }},
};

}  // namespace

bool is_iges(std::string_view bytes) { return is_iges_head(bytes.substr(0, head_size)); }

std::optional<Error> foreign_format(std::string_view bytes) {
  const auto error = [](std::string what, std::string remedy) {
    return Error{ErrorKind::input, std::move(what), {}, std::move(remedy)};
  };
  if (bytes.empty())
    return error("not a STEP file: it is empty", "export the model again, as a STEP file");
  std::string_view head = bytes.substr(0, head_size);
  if (head.starts_with("\xFF\xFE") || head.starts_with("\xFE\xFF")) {
    return error("not a STEP file: its text is UTF-16",
                 "save it as plain text, one byte per character");
  }
  if (head.starts_with("\xEF\xBB\xBF")) head.remove_prefix(3);
  for (const Known& format : cad_formats) {
    if (!format.recognised(head)) continue;
    return error(fmt::format("not a STEP file but {}", format.name),
                 "open it in the program that wrote it, and export it as STEP (AP214 or AP242)");
  }
  if (is_script(head)) {
    return is_document(head) ? error("not a STEP file but a Knead document",
                                     "open it in the studio, and save the CAD file there; `knead "
                                     "info` lists its content")
                             : error("not a STEP file but a script",
                                     "name the CAD file, and the script with --script");
  }
  const bool binary_stl = is_binary_stl(bytes);
  for (const Known& format : mesh_formats) {
    if (!format.recognised(head) && !(binary_stl && format.recognised == is_text_stl)) continue;
    return error(
        fmt::format("not a STEP file but {}, a mesh without B-spline surfaces", format.name),
        "export the model that it was made of as STEP");
  }
  for (const Known& format : packed_formats) {
    if (format.recognised(head)) {
      return error(fmt::format("not a STEP file but {}", format.name),
                   "unpack it, and open the STEP file in it");
    }
  }
  return std::nullopt;
}

}  // namespace knead::detail
