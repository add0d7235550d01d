/**
 * @file
 * Where things are: programs beside this one; models, console and documents in the installation or the source
 * tree.
 */
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/exit_code.hpp"

namespace interlock::cli {

class Installation {
 public:
  /** Looks for programs in `programs`, and for everything else in the roots, first to last. */
  Installation(std::filesystem::path programs, std::vector<std::filesystem::path> roots)
      : programs_(std::move(programs)), roots_(std::move(roots)) {}

  /** The installation that this very program belongs to, then the source tree it was built from. */
  static Installation current();

  /** An executable program of Interlock. */
  [[nodiscard]] Result<std::filesystem::path> program(const std::string& name) const;

  /** A robot's file: `robot` itself when it looks like a file (`x.toml` or with a `/`), else the robot of
   * that name. */
  [[nodiscard]] Result<std::filesystem::path> robot(const std::string& robot) const;

  /** The files of all robots. */
  [[nodiscard]] std::vector<std::filesystem::path> robots() const;

  /** Parameters of the simulated hardware of the robot of that name. */
  [[nodiscard]] Result<std::filesystem::path> plant(const std::string& robot_name) const;

  /** The built console, if there is one. */
  [[nodiscard]] std::optional<std::filesystem::path> web() const;

  /** The built documents, if there are any. */
  [[nodiscard]] std::optional<std::filesystem::path> documents() const;

 private:
  [[nodiscard]] Result<std::filesystem::path> model(const std::string& kind, const std::string& name) const;

  std::filesystem::path programs_;
  std::vector<std::filesystem::path> roots_;
};

}  // namespace interlock::cli
