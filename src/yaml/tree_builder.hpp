// SPDX-FileCopyrightText: 2026 the bbsim authors
// SPDX-License-Identifier: BSD-3-Clause

// Builds nodes from yaml-cpp's events.
#pragma once

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/mark.h>

#include <optional>
#include <string>
#include <vector>

#include "yaml/document.hpp"

namespace bbsim::yaml {

// Builds the tree of one document. Throws TextFault for content that a scenario may not hold.
class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(int source, Nodes& nodes) : source_(source), nodes_(nodes) {}

  [[nodiscard]] const Node* root() const { return root_; }

  void OnDocumentStart(const YAML::Mark& mark) override;
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override;
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override;
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override;
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value style) override;
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value style) override;
  void OnMapEnd() override { close(); }

 private:
  struct Key {
    std::string name;
    Position position;
  };
  struct Open {  // a sequence or mapping that has not ended
    Node* node;
    YAML::anchor_t anchor;
    std::optional<Key> key;  // of a mapping: read, but still without its value
  };

  [[nodiscard]] Position at(const YAML::Mark& mark) const;
  [[nodiscard]] bool expects_key() const;
  Node& add(Node::Kind kind, const YAML::Mark& mark);
  void refuse_tag(const std::string& tag, const YAML::Mark& mark) const;
  void open(Node::Kind kind, const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor);
  void close();
  void complete(const Node& node, YAML::anchor_t anchor);

  int source_;
  Nodes& nodes_;
  const Node* root_ = nullptr;
  bool started_ = false;
  std::vector<Open> open_;
  std::vector<const Node*> anchored_;  // by anchor; nullptr while the node is open
};

}  // namespace bbsim::yaml
