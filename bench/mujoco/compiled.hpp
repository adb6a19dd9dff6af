// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

#pragma once

#include <mujoco/mujoco.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <string>

// Compiles a scene in MuJoCo's XML. Ends the program with exit code 1 if MuJoCo refuses it.
inline std::unique_ptr<mjModel, decltype(&mj_deleteModel)> compiled(const std::string& xml) {
  const auto files = std::make_unique<mjVFS>();  // in memory
  mj_defaultVFS(files.get());
  mj_makeEmptyFileVFS(files.get(), "scene.xml", static_cast<int>(xml.size()));
  std::memcpy(files->filedata[0], xml.data(), xml.size());
  char error[500] = "";
  std::unique_ptr<mjModel, decltype(&mj_deleteModel)> model(
      mj_loadXML("scene.xml", files.get(), error, sizeof error), mj_deleteModel);
  mj_deleteVFS(files.get());
  if (model) return model;
  std::fprintf(stderr, "MuJoCo: %s\n", error);
  std::exit(1);
}
