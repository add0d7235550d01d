/**
 * @file
 * Where things are: programs beside this one; models, console and documents in the installation or the source
 * tree.
 */
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/exit_code.hpp"

namespace interlock::cli {

class Installation {
 public:
  /** Looks for programs in `programs`, and for everything else in `data`. */
  Installation(std::filesystem::path programs, std::filesystem::path data)
      : programs_(std::move(programs)), data_(std::move(data)) {}

  /** What this very program belongs to: an installation (PREFIX/bin) or a source tree (build/PRESET/bin). */
  static Installation current();

  /** Where everything but the programs is: share/interlock of an installation, or the top of a source tree.
   */
  [[nodiscard]] const std::filesystem::path& data() const { return data_; }

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
  [[nodiscard]] std::optional<std::filesystem::path> folder_with(const std::string& file,
                                                                 std::array<const char*, 2> folders) const;

  std::filesystem::path programs_;
  std::filesystem::path data_;
};

}  // namespace interlock::cli
