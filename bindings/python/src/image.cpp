#include <algorithm>

#include "binding.hpp"
#include "knead/image/snake_script.hpp"
#include "working.hpp"

namespace knead::python {
namespace {

Image image_of(const Doubles& pixels) {
  return {static_cast<int>(pixels.extent(1)), static_cast<int>(pixels.extent(0)), pixels.vector()};
}

VolumeImage volume_of(const Doubles& voxels) {
  return {{static_cast<int>(voxels.extent(2)), static_cast<int>(voxels.extent(1)),
           static_cast<int>(voxels.extent(0))},
          voxels.vector(),
          {}};
}

Expected<Snakes> started(const Image& image, const SnakeScript& script,
                         const std::optional<Image>& mask) {
  const auto potential = ImagePotential::create(image, script.image, mask);
  if (!potential) return std::unexpected(potential.error().within("image"));
  const auto begin = beginnings_of(script, image);
  return begin ? Snakes::create(*potential, begin->curves, begin->settings)
               : std::unexpected(begin.error());
}

/// Until all rest, or the work is stopped: then where they are.
Expected<std::vector<SnakeResult>> run(const Image& image, const SnakeScript& script,
                                       const std::optional<Image>& mask, Work& work) {
  auto snakes = started(image, script, mask);
  if (!snakes) return std::unexpected(snakes.error());
  constexpr int at_a_time = 5;
  const int most = script.settings.max_iterations;
  for (int steps = 0; !snakes->ended() && work.tell(std::min(steps, most), most);
       steps += at_a_time) {
    if (auto more = snakes->advance(at_a_time); !more) return std::unexpected(more.error());
  }
  auto results = snakes->results();
  if (!results) return results;
  int made = 0;
  for (const SnakeResult& s : *results) made = std::max(made, s.iterations);
  work.tell(made, made);  // that is all of them
  return results;
}

py::list image_snakes(const py::object& picture, const std::string& json, const py::object& mask,
                      py::object progress) {
  const Image image = image_of(Doubles(picture));
  std::optional<Image> drawn;
  if (!mask.is_none()) drawn = image_of(Doubles(mask));
  const SnakeScript script = value_of(parse_snake_script(json));
  Work work(std::move(progress));
  auto made = without_interpreter([&] { return run(image, script, drawn, work); });
  work.finish();
  py::list result;
  for (SnakeResult& s : value_of(std::move(made))) {
    Image inside = mask_of(s, image.width, image.height);
    const int crossed = crossings(s);
    result.append(
        py::make_tuple(Held<1>{std::make_shared<const Curve>(std::move(s.curve))}, s.closed,
                       s.iterations, s.converged, s.last_motion, crossed,
                       view_of_own(std::move(inside.values), {image.height, image.width})));
  }
  return result;
}

py::list volume_snakes(const py::object& voxels, const py::object& origin,
                       const py::object& directions, const std::string& json,
                       const py::object& mask) {
  VolumeImage volume = volume_of(Doubles(voxels));
  std::ranges::copy(Doubles(origin).span(), volume.frame.origin.data());
  const Doubles steps(directions);  // row i: the step along the i-th direction of the frame
  volume.frame.directions = Eigen::Map<const Eigen::Matrix3d>(steps.span().data());
  std::optional<VolumeImage> drawn;
  if (!mask.is_none()) drawn = volume_of(Doubles(mask));
  const VolumeSnakeScript script = json.empty() ? default_volume_snake_script(volume)
                                                : value_of(parse_volume_snake_script(json));
  auto made = without_interpreter([&] { return run_volume_snakes(volume, script, drawn); });
  py::list result;
  for (SurfaceSnakeResult& s : value_of(std::move(made))) {
    const SurfaceMeasure m = measure(s.snake);
    const ClosedMesh mesh = closed_mesh(s.snake);
    VolumeImage inside = mask_of(mesh, volume.size, volume.frame);
    const char* form = s.snake.form == SurfaceForm::torus ? "torus" : "sphere";
    result.append(py::make_tuple(
        Held<2>{std::make_shared<const Surface>(std::move(s.snake.surface))}, form, s.iterations,
        s.converged, s.last_motion, crossings(mesh), m.area, m.volume,
        view_of_own(std::move(inside.values), {volume.size[2], volume.size[1], volume.size[0]})));
  }
  return result;
}

}  // namespace

void bind_image(py::module_& module) {
  module.def("image_snakes", &image_snakes);
  module.def("volume_snakes", &volume_snakes);
}

}  // namespace knead::python
