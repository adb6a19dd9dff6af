// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#include "replay/gltf.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <utility>

#include "base/error.hpp"
#include "file/atomic_file.hpp"
#include "replay/base64.hpp"
#include "replay/gltf_buffer.hpp"
#include "replay/kept_rows.hpp"
#include "replay/page.hpp"
#include "replay/rotation.hpp"
#include "replay/shapes.hpp"
#include "replay/stage.hpp"

namespace bbsim::replay {
namespace {

using Json = nlohmann::ordered_json;
using Vector = std::array<double, 3>;

// glTF puts the scalar last.
Json gltf_rotation(const Quaternion& q) {
  return {q[1], q[2], q[3], q[0]};
}

std::array<float, 4> rounded(const Quaternion& q) {
  return {to_float(q[1]), to_float(q[2]), to_float(q[3]), to_float(q[0])};
}

// The values of a column in some rows, or 0 without the column. A value that is not finite repeats
// the last finite one.
std::vector<double> values_of(const Run& run, std::string_view name,
                              const std::vector<std::size_t>& rows) {
  const Series* series = find_series(run, name);
  std::vector<double> result;
  result.reserve(rows.size());
  double last = 0;
  for (const std::size_t row : rows) {
    if (series != nullptr && std::isfinite(to_float(series->values[row]))) {
      last = series->values[row];
    }
    result.push_back(last);
  }
  return result;
}

class Writer {
 public:
  explicit Writer(const Scene& scene) : scene_(scene), stage_(stage_of(scene)) {
    add_materials();
    add_meshes();
  }

  std::string file() {
    start_ = find_series(scene_.runs.front(), "t")->values.front();
    for (const Run& run : scene_.runs) {
      start_ = std::min(start_, find_series(run, "t")->values.front());
    }
    const std::size_t root =
        add_node({{"name", "bbsim"},
                  {"rotation", gltf_rotation(rotation_by({-std::numbers::pi / 2, 0, 0}))}});
    for (const Run& run : scene_.runs) add_run(run, root);
    json_["asset"] = {{"version", "2.0"}, {"generator", "bbsim " + scene_.version}};
    json_["scene"] = 0;
    json_["scenes"] = Json::array({{{"name", scene_.title}, {"nodes", {root}}}});
    json_["nodes"] = nodes_;
    json_["meshes"] = meshes_;
    json_["materials"] = materials_;
    if (!channels_.empty()) {
      json_["animations"] =
          Json::array({{{"name", "replay"}, {"samplers", samplers_}, {"channels", channels_}}});
    }
    return buffer_.file(json_);
  }

 private:
  enum Material { plate_colour, frame_colour, ball_light, ball_dark, ghost_dark, path_colour };

  // Meshes of unit size, scaled by nodes.
  struct Meshes {
    std::size_t plate, frame_box, frame_ring;
    std::array<std::array<std::optional<std::size_t>, 2>, 2>
        balls;  // of the leading run, of others
  };

  void add_materials() {
    const auto add = [&](const char* name, double r, double g, double b, double metal,
                         double rough) {
      materials_.push_back({{"name", name},
                            {"pbrMetallicRoughness",
                             {{"baseColorFactor", {r, g, b, 1.0}},
                              {"metallicFactor", metal},
                              {"roughnessFactor", rough}}}});
    };
    add("plate", 0.78, 0.80, 0.83, 0.1, 0.35);
    add("frame", 0.16, 0.19, 0.24, 0.6, 0.4);
    add("ball, light", 0.95, 0.94, 0.90, 0, 0.3);
    add("ball, dark", 0.80, 0.22, 0.03, 0, 0.3);
    add("ghost, dark", 0.0, 0.22, 0.55, 0, 0.3);
    add("path", 0.0, 0.22, 0.55, 0, 1);
  }

  Json primitive(const Mesh& mesh, Material material) {
    Json attributes = Json::object();
    attributes["POSITION"] = buffer_.add_vertices(mesh.positions, true);
    attributes["NORMAL"] = buffer_.add_vertices(mesh.normals, false);
    return {{"attributes", attributes},
            {"indices", buffer_.add_indices(mesh.triangles)},
            {"material", material}};
  }

  std::size_t add_mesh(const std::string& name, const Json& primitives) {
    meshes_.push_back({{"name", name}, {"primitives", primitives}});
    return meshes_.size() - 1;
  }

  void add_meshes() {
    Json box = primitive(unit_box(), frame_colour);
    made_.frame_box = add_mesh("bar", Json::array({box}));
    if (stage_.round) {
      made_.plate = add_mesh("plate", Json::array({primitive(unit_cylinder(), plate_colour)}));
      made_.frame_ring = add_mesh("ring", Json::array({primitive(ring(bar_part), frame_colour)}));
    } else {
      box["material"] = plate_colour;
      made_.plate = add_mesh("plate", Json::array({box}));
    }
    light_ = primitive(octants(false), ball_light);
    dark_ = primitive(octants(true), ball_dark);
  }

  // A ball with marks; a ball of one color if its rotation is unknown.
  std::size_t ball_mesh(bool leads, bool turns_known) {
    std::optional<std::size_t>& made = made_.balls[leads ? 0 : 1][turns_known ? 0 : 1];
    if (made) return *made;
    Json light = light_, dark = dark_;
    dark["material"] = leads ? ball_dark : ghost_dark;
    if (!turns_known) light["material"] = dark["material"];
    made = add_mesh(leads ? "ball" : "ghost", Json::array({light, dark}));
    return *made;
  }

  std::size_t add_node(Json node) {
    nodes_.push_back(std::move(node));
    return nodes_.size() - 1;
  }

  std::size_t add_child(std::size_t parent, Json node) {
    const std::size_t child = add_node(std::move(node));
    Json& children = nodes_[parent]["children"];
    if (children.is_null()) children = Json::array();
    children.push_back(child);
    return child;
  }

  void add_bar(std::size_t parent, const char* name, const Vector& centre, const Vector& size) {
    add_child(
        parent,
        {{"name", name}, {"mesh", made_.frame_box}, {"translation", centre}, {"scale", size}});
  }

  void animate(std::size_t node, const char* path, std::size_t times, std::size_t values) {
    samplers_.push_back({{"input", times}, {"output", values}, {"interpolation", "LINEAR"}});
    channels_.push_back(
        {{"sampler", samplers_.size() - 1}, {"target", {{"node", node}, {"path", path}}}});
  }

  // The posts of the base and the axles of phi, sized for the plate.
  void add_base(std::size_t base) {
    const double bar = static_cast<double>(bar_part) * std::max(stage_.width, stage_.depth);
    const double y = stage_.depth / 2 + 5 * bar, post = 0.5 * std::max(stage_.width, stage_.depth);
    for (const double side : {-1.0, 1.0}) {
      add_bar(base, "post", {0, side * (y + bar), -post / 2}, {2 * bar, bar, post + 2 * bar});
      add_bar(base, "axle of phi", {0, side * (y - bar / 2), 0}, {bar, 3 * bar, bar});
    }
    add_bar(base, "foot", {0, 0, -post - bar}, {4 * bar, 2 * (y + 1.5 * bar), bar});
  }

  void add_ring(std::size_t node) {
    const double longest = std::max(stage_.width, stage_.depth);
    const double bar = static_cast<double>(bar_part) * longest;
    if (stage_.round) {
      const double radius = stage_.depth / 2 + 3 * bar;
      add_child(
          node,
          {{"name", "frame"}, {"mesh", made_.frame_ring}, {"scale", {radius, radius, radius}}});
      return;
    }
    const double x = stage_.width / 2 + 3 * bar, y = stage_.depth / 2 + 3 * bar;
    for (const double side : {-1.0, 1.0}) {
      add_bar(node, "frame", {side * x, 0, 0}, {bar, 2 * y + bar, bar});
      add_bar(node, "frame", {0, side * y, 0}, {2 * x - bar, bar, bar});
    }
  }

  void add_hinge(std::size_t node) {
    const double bar = static_cast<double>(bar_part) * std::max(stage_.width, stage_.depth);
    for (const double side : {-1.0, 1.0}) {
      add_bar(node, "axle of theta", {side * (stage_.width / 2 + 1.5 * bar), 0, 0},
              {3 * bar, bar / 2, bar / 2});
    }
  }

  // Adds a gimbal for the run, animated by its angles, and returns the node of its plane.
  std::size_t add_gimbal(const Run& run, std::size_t root, std::size_t times,
                         const std::vector<std::size_t>& rows) {
    const std::size_t base =
        add_child(root, {{"name", "base"},
                         {"rotation", gltf_rotation(rotation_by({run.mounting.base_tilt, 0, 0}))}});
    add_base(base);
    const std::size_t ring = add_child(base, {{"name", "ring"}});
    add_ring(ring);
    const std::size_t cross =
        add_child(ring, {{"name", "theta's axis"},
                         {"rotation", gltf_rotation(rotation_by({0, 0, run.mounting.skew}))}});
    const std::size_t hinge = add_child(cross, {{"name", "hinge"}});
    add_hinge(hinge);
    const std::size_t plane = add_child(
        hinge,
        {{"name", "plane"},
         {"rotation", gltf_rotation(rotation_by({0, 0, run.mounting.yaw - run.mounting.skew}))}});
    const double thickness = 0.02 * std::max(stage_.width, stage_.depth);
    add_child(plane, {{"name", "plate"},
                      {"mesh", made_.plate},
                      {"translation", {0, 0, run.mounting.height - thickness / 2}},
                      {"scale", {stage_.width, stage_.depth, thickness}}});
    std::vector<std::array<float, 4>> phi, theta;
    for (const double angle : values_of(run, "phi", rows)) {
      phi.push_back(rounded(rotation_by({0, angle, 0})));
    }
    for (const double angle : values_of(run, "theta", rows)) {
      theta.push_back(rounded(rotation_by({angle, 0, 0})));
    }
    animate(ring, "rotation", times, buffer_.add_quaternions(phi));
    animate(hinge, "rotation", times, buffer_.add_quaternions(theta));
    return plane;
  }

  void add_path(const std::string& name, std::size_t plane,
                const std::vector<std::array<float, 3>>& centres, float below) {
    if (centres.size() < 2) return;
    std::vector<std::array<float, 3>> points = centres;
    for (auto& point : points) point[2] -= below;
    Json attributes = Json::object();
    attributes["POSITION"] = buffer_.add_vertices(points, true);
    constexpr int line_strip = 3;
    const Json line = {{"attributes", attributes}, {"mode", line_strip}, {"material", path_colour}};
    add_child(plane,
              {{"name", "path of " + name}, {"mesh", add_mesh("path", Json::array({line}))}});
  }

  // The kept rows with increasing times as floats, which animations require. Times count from
  // start_.
  std::vector<std::size_t> animated_rows(const Run& run, const std::vector<Quaternion>& orientation,
                                         std::vector<float>& times) const {
    std::vector<std::size_t> rows;
    const std::vector<double>& t = find_series(run, "t")->values;
    for (const std::size_t row : kept_rows(run, orientation, rows_allowed(scene_)).rows) {
      const float time = to_float(t[row] - start_);
      if (!times.empty() && time <= times.back()) continue;
      times.push_back(time);
      rows.push_back(row);
    }
    return rows;
  }

  void add_run(const Run& run, std::size_t root) {
    const bool leads = &run == &scene_.runs.front();
    const double radius = run.ball_radius.value_or(stage_.ball_radius);
    const std::vector<Quaternion> orientation = orientation_of(run, radius);
    std::vector<float> seconds;
    const std::vector<std::size_t> rows = animated_rows(run, orientation, seconds);
    const std::size_t times = buffer_.add_scalars(seconds);

    const bool has_angles =
        find_series(run, "phi") != nullptr || find_series(run, "theta") != nullptr;
    const std::size_t plane = leads || has_angles ? add_gimbal(run, root, times, rows) : plane_;
    if (leads) plane_ = plane;

    const std::vector<double> x = values_of(run, "x", rows), y = values_of(run, "y", rows);
    const double height = run.mounting.height + radius;
    std::vector<std::array<float, 3>> centres;
    std::vector<std::array<float, 4>> turns;
    Quaternion last{1, 0, 0, 0};
    const bool turns_known = !orientation.empty();
    for (std::size_t i = 0; i < rows.size(); ++i) {
      centres.push_back({to_float(x[i]), to_float(y[i]), to_float(height)});
      if (!turns_known) continue;
      Quaternion q = orientation[rows[i]];
      // q and -q are the same rotation. Takes the one nearer to the last, because some players do
      // not.
      if (q[0] * last[0] + q[1] * last[1] + q[2] * last[2] + q[3] * last[3] < 0) {
        for (double& component : q) component = -component;
      }
      turns.push_back(rounded(q));
      last = q;
    }
    const std::size_t ball = add_child(plane, {{"name", "ball of " + run.name},
                                               {"mesh", ball_mesh(leads, turns_known)},
                                               {"scale", {radius, radius, radius}}});
    animate(ball, "translation", times, buffer_.add_vectors(centres));
    if (turns_known) animate(ball, "rotation", times, buffer_.add_quaternions(turns));
    add_path(run.name, plane, centres, to_float(0.98 * radius));
  }

  // The width of the frame's bars, relative to the plate.
  static constexpr float bar_part = 0.025F;

  const Scene& scene_;
  Stage stage_;
  GltfBuffer buffer_;
  Json json_ = Json::object();
  Json nodes_ = Json::array(), meshes_ = Json::array(), materials_ = Json::array();
  Json samplers_ = Json::array(), channels_ = Json::array();
  Meshes made_{};
  Json light_, dark_;      // octants of the ball
  double start_ = 0;       // earliest time of all runs, s
  std::size_t plane_ = 0;  // of the leading run
};

}  // namespace

std::string gltf(const Scene& scene) {
  check_scene(scene);
  if (scene.runs.empty()) {
    throw InputError("a sweep has no motion to write as glTF; allowed: runs");
  }
  return Writer(scene).file();
}

void write_gltf(const std::string& file, const Scene& scene) {
  file::write_file(file, gltf(scene));
}

}  // namespace bbsim::replay
