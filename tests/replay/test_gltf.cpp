// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// A .glb read back by the rules of glTF 2.0. scripts/check-gltf also runs Khronos' validator.
#include <cmath>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "catch.hpp"
#include "make_scene.hpp"
#include "replay/gltf.hpp"
#include "replay/rotation.hpp"

using bbsim::replay::gltf;
using bbsim::replay::Scene;
using bbsim_test::circling;

namespace {

std::uint32_t word(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    value |= static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[at + i])) << (8 * i);
  }
  return value;
}

struct File {
  nlohmann::json json;
  std::string bytes;

  [[nodiscard]] std::vector<float> floats(std::size_t accessor) const {
    const auto& a = json.at("accessors").at(accessor);
    const auto& view = json.at("bufferViews").at(a.at("bufferView").get<std::size_t>());
    const std::string type = a.at("type");
    const std::size_t width = type == "SCALAR" ? 1 : type == "VEC3" ? 3 : 4;
    std::vector<float> values(a.at("count").get<std::size_t>() * width);
    std::memcpy(values.data(), bytes.data() + view.at("byteOffset").get<std::size_t>(),
                values.size() * sizeof(float));
    return values;
  }
  // Times and values of the channel that animates a path of a node.
  [[nodiscard]] std::pair<std::vector<float>, std::vector<float>> channel(
      const std::string& node, const std::string& path) const {
    const auto& animation = json.at("animations").at(0);
    for (const auto& channel : animation.at("channels")) {
      const auto& target = channel.at("target");
      const auto& named = json.at("nodes").at(target.at("node").get<std::size_t>());
      if (named.at("name") != node || target.at("path") != path) continue;
      const auto& sampler = animation.at("samplers").at(channel.at("sampler").get<std::size_t>());
      return {floats(sampler.at("input")), floats(sampler.at("output"))};
    }
    return {};
  }
};

File read(const std::string& glb) {
  REQUIRE(glb.size() > 28);
  CHECK(glb.substr(0, 4) == "glTF");
  CHECK(word(glb, 4) == 2);
  CHECK(word(glb, 8) == glb.size());
  const std::uint32_t length = word(glb, 12);
  CHECK(glb.substr(16, 4) == "JSON");
  CHECK(length % 4 == 0);
  const std::size_t bin = 20 + length;
  CHECK(glb.substr(bin + 4, 3) == "BIN");
  CHECK(word(glb, bin) % 4 == 0);
  return {nlohmann::json::parse(glb.substr(20, length)), glb.substr(bin + 8)};
}

Scene scene() {
  Scene scene;
  scene.title = "A </circle>";
  scene.version = "1.2.3";
  scene.runs.push_back(circling(300));
  return scene;
}

}  // namespace

TEST_CASE("a .glb moves ring, hinge and ball by the rows") {
  const Scene from = scene();
  const File file = read(gltf(from));
  CHECK(file.json.at("asset").at("version") == "2.0");
  CHECK(file.json.at("buffers").at(0).at("byteLength") == file.bytes.size());
  const auto& columns = from.runs[0].columns;

  const auto [times, centres] = file.channel("ball of circle.csv", "translation");
  REQUIRE(times.size() == 300);
  REQUIRE(centres.size() == 900);
  for (std::size_t i = 0; i < times.size(); ++i) {
    CHECK(times[i] == static_cast<float>(columns[0].values[i]));
    CHECK(centres[3 * i] == static_cast<float>(columns[1].values[i]));
    CHECK(centres[3 * i + 1] == static_cast<float>(columns[2].values[i]));
    CHECK(centres[3 * i + 2] == 0.01F);
  }
  const auto [ring_times, ring] = file.channel("ring", "rotation");
  const auto [hinge_times, hinge] = file.channel("hinge", "rotation");
  REQUIRE(ring.size() == 1200);
  for (std::size_t i = 0; i < 300; ++i) {
    // x, y, z, w: phi about y, theta about x. Within float rounding of values of size 1.
    CHECK(ring[4 * i + 1] == Approx(std::sin(columns[3].values[i] / 2)).margin(1e-7));
    CHECK(hinge[4 * i] == Approx(std::sin(columns[4].values[i] / 2)).margin(1e-7));
    CHECK(ring[4 * i + 3] == Approx(std::cos(columns[3].values[i] / 2)));
  }
  const auto [turn_times, turns] = file.channel("ball of circle.csv", "rotation");
  const auto expected = bbsim::replay::orientation_of(from.runs[0], 0.01);
  for (std::size_t i = 0; i < 300; ++i) {
    double dot = 0;
    for (std::size_t k = 0; k < 4; ++k) dot += turns[4 * i + k] * expected[i][(k + 1) % 4];
    CHECK(std::abs(dot) == Approx(1));
  }
}

TEST_CASE("accessors' bounds match their numbers, and their bytes exist") {
  const File file = read(gltf(scene()));
  for (std::size_t a = 0; a < file.json.at("accessors").size(); ++a) {
    const auto& accessor = file.json.at("accessors").at(a);
    const auto& view = file.json.at("bufferViews").at(accessor.at("bufferView").get<std::size_t>());
    const auto offset = view.at("byteOffset").get<std::size_t>();
    CHECK(offset % 4 == 0);
    CHECK(offset + view.at("byteLength").get<std::size_t>() <= file.bytes.size());
    if (!accessor.contains("min")) continue;
    const std::size_t width = accessor.at("min").size();
    const auto values = file.floats(a);
    for (std::size_t i = 0; i < values.size(); ++i) {
      CHECK(static_cast<double>(values[i]) >= accessor.at("min").at(i % width).get<double>());
      CHECK(static_cast<double>(values[i]) <= accessor.at("max").at(i % width).get<double>());
    }
  }
}

TEST_CASE("the ball's octants face outward and cover the ball") {
  const File file = read(gltf(scene()));
  double area = 0;
  for (const auto& mesh : file.json.at("meshes")) {
    if (mesh.at("name") != "ball") continue;
    for (const auto& primitive : mesh.at("primitives")) {
      const auto points = file.floats(primitive.at("attributes").at("POSITION"));
      const auto& view = file.json.at("bufferViews")
                             .at(file.json.at("accessors")
                                     .at(primitive.at("indices").get<std::size_t>())
                                     .at("bufferView")
                                     .get<std::size_t>());
      const auto count = file.json.at("accessors")
                             .at(primitive.at("indices").get<std::size_t>())
                             .at("count")
                             .get<std::size_t>();
      std::vector<std::uint16_t> corners(count);
      std::memcpy(corners.data(), file.bytes.data() + view.at("byteOffset").get<std::size_t>(),
                  2 * count);
      for (std::size_t i = 0; i < count; i += 3) {
        const auto p = [&](std::size_t k) {
          return std::array<double, 3>{points[3 * corners[i + k]], points[3 * corners[i + k] + 1],
                                       points[3 * corners[i + k] + 2]};
        };
        const auto a = p(0), b = p(1), c = p(2);
        const double ux = b[0] - a[0], uy = b[1] - a[1], uz = b[2] - a[2];
        const double vx = c[0] - a[0], vy = c[1] - a[1], vz = c[2] - a[2];
        const double nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
        CHECK(nx * a[0] + ny * a[1] + nz * a[2] >= -1e-9);
        area += std::hypot(nx, ny, nz) / 2;
      }
    }
  }
  // The area is that of the sphere, minus the effect of flat faces: below 2 % with 8 steps per
  // eighth.
  CHECK(area > 0.98 * 4 * 3.14159);
  CHECK(area < 4 * 3.1416);
}

TEST_CASE("a ball of unknown orientation has one color and does not turn") {
  Scene unknown = scene();
  unknown.runs[0].rolls = false;
  const File file = read(gltf(unknown));
  for (const auto& channel : file.json.at("animations").at(0).at("channels")) {
    const auto& node = file.json.at("nodes").at(channel.at("target").at("node").get<std::size_t>());
    if (node.at("name") == "ball of circle.csv")
      CHECK(channel.at("target").at("path") != "rotation");
  }
  for (const auto& mesh : file.json.at("meshes")) {
    if (mesh.at("name") != "ball") continue;
    CHECK(mesh.at("primitives").at(0).at("material") == mesh.at("primitives").at(1).at("material"));
  }
}

TEST_CASE("a second run has its ghost, on its own gimbal or on the first one's plate") {
  Scene two = scene();
  two.runs.push_back(circling(200));
  two.runs[1].name = "log.csv";
  const auto count = [](const File& file, const std::string& name) {
    int found = 0;
    for (const auto& node : file.json.at("nodes")) found += node.at("name") == name ? 1 : 0;
    return found;
  };
  CHECK(count(read(gltf(two)), "ring") == 2);
  two.runs[1].columns.erase(two.runs[1].columns.begin() + 3, two.runs[1].columns.end());
  const File file = read(gltf(two));
  CHECK(count(file, "ring") == 1);
  CHECK(file.channel("ball of log.csv", "translation").first.size() == 200);
}

TEST_CASE("times start at the first run's start and increase also as floats") {
  Scene late = scene();
  std::vector<double>& t = late.runs[0].columns[0].values;
  for (std::size_t i = 0; i < t.size(); ++i) t[i] = 1e6 + 1e-9 * static_cast<double>(i);
  t.back() = 1e6 + 1;
  const auto times = read(gltf(late)).channel("ring", "rotation").first;
  CHECK(times.front() == 0);
  CHECK(times.back() == 1);
  for (std::size_t i = 1; i < times.size(); ++i) CHECK(times[i] > times[i - 1]);
}

TEST_CASE("a round plate has a round frame, and a sweep has no motion") {
  Scene round = scene();
  round.runs[0].plate = {{}, 0.3};
  CHECK(gltf(round).find("\"ring\"") != std::string::npos);
  Scene sweep;
  sweep.sweeps.push_back(bbsim_test::swept());
  CHECK_THROWS_AS(gltf(sweep), bbsim::InputError);
}
