// Pictures of surfaces and tools, and what colours them.
#include "query.hpp"
#include "scene/display_range.hpp"
#include "tool_picture.hpp"

namespace knead {

static std::span<const Choice> choices(DisplayPalette) {
  static constexpr Choice list[] = {{"diverging", DisplayPalette::diverging},
                                    {"rising", DisplayPalette::rising}};
  return list;
}

static void describe(DisplayRange& r, Fields& fields) {
  fields.name("display range",
              "Where colours end by themselves, and the least and greatest of all visible values.");
  fields.add("lower", r.lower);
  fields.add("upper", r.upper);
  fields.add("least", r.least);
  fields.add("greatest", r.greatest);
}

}  // namespace knead

namespace knead::studio {

static void describe(PictureWindow& w, Fields& fields) {
  fields.name("picture window", "What is looked at from nearby: a part of a surface.");
  fields.add("lower", w.lower, {.help = "fractions of the domain", .presence = Presence::required});
  fields.add("upper", w.upper, {.presence = Presence::required});
  fields.add("tolerance", w.tolerance,
             {.help = "how far chords may be from the surface there, in units of the file",
              .presence = Presence::required});
}

static void describe(Picture& p, Fields& fields) {
  fields.name("picture",
              "A surface to draw, as a grid of points: (k, l) is number k counts[1] + l.");
  fields.add("surface", p.surface, {.help = "its number"});
  fields.add("window", p.window);
  fields.add("counts", p.counts);
  fields.add("positions", p.positions, {.help = "relative to the session's origin"});
  fields.add("normals", p.normals);
  fields.add("values", p.values, {.help = "of the display; empty without one"});
  fields.add("s", p.s, {.help = "fractions of the domain, per grid line"});
  fields.add("t", p.t);
  fields.add("lines_u", p.lines_u, {.help = "grid lines that are knot lines"});
  fields.add("lines_v", p.lines_v);
  fields.add("coarse_u", p.coarse_u,
             {.help = "grid lines that are there without a window; empty: all"});
  fields.add("coarse_v", p.coarse_v);
  fields.add("net", p.net, {.help = "control points"});
  fields.add("held", p.held,
             {.help = "per control point: 0 free, 1 does not move, 2 bound to others (pinned "
                      "surface points, kept curves)"});
}

static void describe(ToolPicture& p, Fields& fields) {
  fields.name("tool picture", "The shape of a tool as triangles in its own frame, unscaled.");
  fields.add("positions", p.positions);
  fields.add("normals", p.normals);
  fields.add("indices", p.indices);
  fields.add("open", p.open, {.help = "both sides are visible"});
  fields.add("unbounded", p.unbounded, {.help = "a square of side 1 stands for a whole plane"});
}

namespace {

struct PictureQuery {
  using Answer = Picture;
  int surface = 0, detail = 96;
  std::string display = "none";
  Settings settings;
  bool opened = false;
  std::optional<PictureWindow> window;
};

void describe(PictureQuery& q, Fields& fields) {
  fields.name("picture", "A surface to draw.");
  fields.add("surface", q.surface, {.help = "its number", .presence = Presence::required});
  fields.add("detail", q.detail, {.help = "grid lines wanted per direction"});
  fields.add("display", q.display, {.help = "what colours it, by its name"});
  fields.add("settings", q.settings, {.help = "of the display"});
  fields.add("opened", q.opened, {.help = "as it was opened"});
  fields.add("window", q.window, {.help = "where there are more grid lines"});
}

Expected<const Picture*> ask(Studio& studio, const PictureQuery& q) {
  if (!studio.session) return nothing_open();
  if (const auto surface = surface_of(*studio.session, q.surface); !surface)
    return std::unexpected(surface.error());
  auto display = asked_display(q.display, q.settings);
  if (!display) return std::unexpected(display.error());
  const bool sees = display->display != nullptr && display->display->sees_model;
  const auto seen = sees ? studio.shown.around(studio.session->document()) : nullptr;
  const PictureOptions options{
      studio.origin, q.detail, *std::move(display), q.opened, visible_part(studio, q.surface),
      q.window,      seen};
  if (auto status = studio.pictures.make(studio.session->state(), q.surface, options); !status) {
    return std::unexpected(std::move(status.error()));
  }
  return &studio.pictures.picture();
}

Expected<std::optional<DisplayRange>> range(Studio& studio) { return studio.pictures.range(); }

Expected<Vector3> origin(Studio& studio) {
  return Vector3{studio.origin[0], studio.origin[1], studio.origin[2]};
}

struct SettingInfo {
  std::string name, title, unit;
  std::vector<double> value;
  std::string help;
};

void describe(SettingInfo& s, Fields& fields) {
  fields.name("display setting", "A number, or a vector, of a display.");
  fields.add("name", s.name);
  fields.add("title", s.title);
  fields.add("unit", s.unit);
  fields.add("value", s.value, {.help = "the default", .uniform = true});
  fields.add("help", s.help);
}

struct DisplayInfo {
  std::string name, title, unit, help, tolerance;
  bool is_signed = false, compares = false, sees_model = false;
  DisplayPalette palette = DisplayPalette::diverging;
  std::optional<std::array<double, 2>> limits;
  std::vector<SettingInfo> settings;
};

void describe(DisplayInfo& d, Fields& fields) {
  fields.name("display info", "What can colour surfaces.");
  fields.add("name", d.name);
  fields.add("title", d.title);
  fields.add("unit", d.unit, {.help = "with length for the unit of the file"});
  fields.add("signed", d.is_signed, {.help = "values may be negative"});
  fields.add("palette", d.palette);
  fields.add("help", d.help);
  fields.add("limits", d.limits,
             {.help = "the values at the ends of the palette; null: those of the range"});
  fields.add(
      "tolerance", d.tolerance,
      {.help = "the setting up to whose magnitude values have the neutral colour; empty for none"});
  fields.add("compares", d.compares, {.help = "with the shape as it was opened"});
  fields.add(
      "sees_model", d.sees_model,
      {.help = "looks at the whole model from every point, which takes longer than a frame may"});
  fields.add("settings", d.settings);
}

Expected<std::vector<DisplayInfo>> displays(Studio&) {
  std::vector<DisplayInfo> answer;
  for (const Display& d : knead::displays()) {
    DisplayInfo& to = answer.emplace_back();
    to.name = d.name;
    to.title = d.title;
    to.unit = d.unit;
    to.help = d.help;
    to.tolerance = d.tolerance;
    to.is_signed = d.is_signed;
    to.compares = d.compares;
    to.sees_model = d.sees_model;
    to.palette = d.palette;
    to.limits = d.limits;
    for (const DisplaySetting& s : d.settings) {
      to.settings.push_back({std::string(s.name), std::string(s.title), std::string(s.unit),
                             s.value, std::string(s.help)});
    }
  }
  return answer;
}

struct ToolPictureQuery {
  using Answer = ToolPicture;
  int tool = 0;
};

void describe(ToolPictureQuery& q, Fields& fields) {
  fields.name("tool_picture", "The shape of a tool.");
  fields.add("tool", q.tool, {.help = "its number", .presence = Presence::required});
}

Expected<ToolPicture> ask(Session& session, const ToolPictureQuery& q) {
  const auto& tools = session.state().tools;
  if (q.tool < 0 || q.tool >= static_cast<int>(tools.size()))
    return usage_error("there is no such tool");
  return tool_picture(tools[static_cast<std::size_t>(q.tool)].shape.shape());
}

}  // namespace

std::vector<Query> picture_queries() {
  return {
      query<PictureQuery>(),
      query<std::optional<DisplayRange>, range>("range",
                                                "Where the colours end of the pictures made since "
                                                "that of the first surface; null without any."),
      query<Vector3, origin>("origin",
                             "What positions of pictures are relative to, in units of the file."),
      query<std::vector<DisplayInfo>, displays>("displays", "All that can colour surfaces."),
      query<ToolPictureQuery>()};
}

}  // namespace knead::studio
