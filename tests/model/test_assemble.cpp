// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Which equations and states a scene gets.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "catch.hpp"
#include "model/hybrid/hybrid_system.hpp"
#include "model/model.hpp"
#include "model/random_states.hpp"
#include "model/spectrum.hpp"
#include "model/systems/list.hpp"
#include "support/scenes.hpp"

namespace bbsim_test::test_assemble {

using namespace bbsim;
using namespace bbsim::model;
using Names = std::vector<std::string>;

namespace {

Scenario tilt_about_y() {
  Scenario scene;
  scene.ball.radius = 0.01;
  scene.ball.position = {0.05, 0};
  scene.gimbal.motion = {{Ramp{0, 2}}, {}};
  scene.time = {5, 0.1};
  return scene;
}

}  // namespace

TEST_CASE("a scene has the states that it needs, and a planar one only those of its axis") {
  const Names open{"x", "y", "vx", "vy", "r*spin"}, along_x{"x", "vx"};
  Names loop = open;
  loop.insert(loop.end(), {"phi", "theta", "phi_rate", "theta_rate"});
  const auto names = [](const Scenario& scene, Form form = Form::reduced) {
    return assemble(scene, true, form).state_names();
  };
  const Scenario planar = tilt_about_y();
  CHECK(names(fig2a()) == open);
  CHECK(names(fig2b()) == loop);
  CHECK(names(planar) == along_x);
  CHECK(names(planar, Form::full) == open);
  Scenario scene = planar;
  std::swap(scene.gimbal.motion->phi, scene.gimbal.motion->theta);
  std::swap(scene.ball.position[0], scene.ball.position[1]);
  CHECK(names(scene) == Names{"y", "vy"});
  scene = planar;
  scene.gimbal.motion->theta = {Sinusoid{0, 1, 0, 0}, Ramp{0, 0}, 0.0};
  CHECK(names(scene) == along_x);
  // The least spin, cross velocity or cross motion makes it full.
  scene.gimbal.motion->theta = {Sinusoid{1e-9, 1, 0, 0}};
  CHECK(names(scene) == open);
  scene = planar;
  scene.ball.spin = 1;
  CHECK(names(scene) == open);
  scene = planar;
  scene.ball.velocity[1] = 1e-300;
  CHECK(names(scene) == open);

  Scenario beam = fig2b();  // ball and beam: only phi is controlled, only x moves
  beam.controller->kv[1] = beam.controller->kp[1] = {0, 0};
  CHECK(names(beam) == Names{"x", "vx", "phi", "phi_rate"});
  beam.gimbal.start.theta = 0.01;
  CHECK(names(beam) == loop);
}

TEST_CASE("gamma is NaN if it was not integrated, and 0 if symmetry keeps it zero") {
  const Model with = assemble(fig2a(), true), without = assemble(fig2a(), false);
  std::vector<double> row = with.initial;
  row.push_back(0.02);
  CHECK(with.sample(0, row.data()).gamma == 2);  // with a radius of 1 cm
  CHECK(std::isnan(without.sample(0, row.data()).gamma));
  for (const bool asked : {true, false}) {
    const Model planar = assemble(tilt_about_y(), asked);
    CHECK_FALSE(planar.gamma);
    CHECK(planar.sample(0, planar.initial.data()).gamma == 0);
  }
}

TEST_CASE("only parts that switch have guards") {
  const auto guards = [](const Scenario& scene) {
    return HybridSystem(assemble(scene, false), 0).guards();
  };
  Scenario scene = fig2b();
  scene.gimbal.servo->angle_limit = 0.1;
  CHECK(guards(scene) == 2 * ServoAxis::guards);
  scene.controller->limit = 0.15;
  CHECK(guards(scene) == 2 * ServoAxis::guards + 4);  // two limits of each command
  scene.events.lift_off = OnEvent::stop;
  const HybridSystem run(assemble(scene, false), 0);
  CHECK(run.guards() == 2 * ServoAxis::guards + 5);
  CHECK(run.first_monitor() == run.guards() - 1);
  CHECK(run.guard_scales().size() == run.guards());
  for (const double scale : run.guard_scales()) CHECK(scale > 0);
  scene = fig2a();
  scene.events.lift_off = OnEvent::stop;
  CHECK(guards(scene) == 1);
}

TEST_CASE("a planar system gives the full system's result") {
  Scenario beam = fig2b();
  beam.controller->kv[1] = beam.controller->kp[1] = {0, 0};
  const auto small =
      std::get<ClosedLoop<Shape::along_x, Drives::angle>>(assemble(beam, false).system);
  beam.ball.spin = 1;  // forces the full system; the state below has no spin
  const auto full = std::get<ClosedLoop<Shape::full, Drives::angle>>(assemble(beam, false).system);

  const double z[4] = {0.03, -0.2, 0.1, -1.5};
  const double z_full[9] = {z[0], 0, z[1], 0, 0, z[2], 0, z[3], 0};
  double dz[4], dz_full[9];
  model::derivative(small, 0.7, z, dz);
  model::derivative(full, 0.7, z_full, dz_full);
  CHECK(dz[0] == dz_full[0]);
  CHECK(dz[1] == dz_full[2]);
  CHECK(dz[2] == dz_full[5]);
  CHECK(dz[3] == dz_full[7]);
}

TEST_CASE("the Jacobian agrees with central differences") {
  Random random(6);
  for (const Scenario& scene : {fig2a(), fig2b(), fig2b_literal(), tilt_about_y()}) {
    const Model model = assemble(scene, false);
    std::visit(
        [&](const auto& system) {
          constexpr int n = std::decay_t<decltype(system)>::size;
          for (int repeat = 0; repeat < 20; ++repeat) {
            double z[n];
            for (double& value : z) value = random.uniform(-0.5, 0.5);
            const double t = random.uniform(0, 5);
            Eigen::Matrix<double, n, n> exact;
            jacobian(model.system, t, z, exact.data());
            for (int j = 0; j < n; ++j) {
              // The step that balances truncation h^2 |f'''| / 6 against rounding eps |f| / h.
              const double h = 6e-6;
              double above[n], below[n], up[n], down[n];
              std::copy_n(z, n, above);
              std::copy_n(z, n, below);
              above[j] += h;
              below[j] -= h;
              model::derivative(system, t, above, up);
              model::derivative(system, t, below, down);
              for (int i = 0; i < n; ++i) {
                const double size = std::abs(up[i]) + std::abs(exact(i, j)) + 1;
                // 2 eps |f| / h and h^2 |f'''|, both about 1e-10 of the size of f.
                CHECK(std::abs(exact(i, j) - (up[i] - down[i]) / (2 * h)) < 5e-10 * size);
              }
            }
          }
        },
        model.system);
  }
}

TEST_CASE("the poles of the closed loop are the roots of its characteristic polynomial") {
  const auto residual = [](std::complex<double> s, double a3, double a2, double a1, double a0) {
    return std::abs(a0 + s * (a1 + s * (a2 + s * (a3 + s))));
  };
  const double a = 5 * 9.81 / 7, r = 0.01;

  SECTION("driving acceleration: s^4 + (a - r s^2)(k_v s + k_p), unstable") {
    Scenario scene = fig2b_literal();
    scene.controller->kv[1][1] = -100;  // with the sign of theta corrected
    scene.controller->kp[1][1] = -0.1;
    const Eigenvalues poles = closed_loop_poles(assemble(scene, false));
    REQUIRE(poles.size() == 8);
    CHECK_FALSE(stable(poles));
    for (const auto& s : poles) {
      const double scale = std::pow(std::abs(s) + 1, 4);
      // Two equal axes give double roots, found only to the square root of rounding.
      CHECK(residual(s, -r * 100, -r * 0.1, a * 100, a * 0.1) < 1e-6 * scale);
    }
  }
  SECTION("through a servo: stable") {
    const Eigenvalues poles = closed_loop_poles(assemble(fig2b(), false));
    REQUIRE(poles.size() == 8);
    CHECK(stable(poles));
    // x'' sees phi'' as -r phi''; the servo's stiffness multiplies the controller's gains.
    const double k = 100, kv = k * 1, kp = k * 0.001;
    for (const auto& s : poles) {
      const double scale = std::pow(std::abs(s) + 1, 4) * 100;
      CHECK(residual(s, 20 - r * kv, k - r * kp, a * kv, a * kp) < 1e-6 * scale);
    }
  }
}

TEST_CASE("stops are the knots of tables inside the scene") {
  Scenario scene = tilt_about_y();
  scene.gimbal.motion->phi = {Table{"m.csv", {0, 1, 2, 3, 5}, {0, 0.1, 0, 0.1, 0}}, 0.2};
  CHECK(assemble(scene, false).stops == std::vector<double>{1, 2, 3});
}

}  // namespace bbsim_test::test_assemble
