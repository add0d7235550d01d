/**
 * @file
 * The directory of one run: sockets and the compiled configuration.
 */
#pragma once

#include <array>
#include <filesystem>
#include <string>

#include "cli/exit_code.hpp"

namespace interlock::cli {

/** Removes what a run leaves in it when it goes: the whole directory, or, in one that was given, its own
 * files. */
class RuntimeDirectory {
 public:
  /** A new private directory under $XDG_RUNTIME_DIR, or under the system's temporary directory. */
  static Result<RuntimeDirectory> make_private(const std::string& robot_name);

  /** A given directory, made if missing and held against other runs. Files of an earlier run in it are
   * removed. */
  static Result<RuntimeDirectory> use(const std::filesystem::path& directory, const std::string& robot_name);

  RuntimeDirectory(RuntimeDirectory&& other) noexcept;
  RuntimeDirectory& operator=(RuntimeDirectory&&) = delete;
  ~RuntimeDirectory();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }
  [[nodiscard]] bool is_private() const { return removes_ == Removes::everything; }
  [[nodiscard]] std::filesystem::path bus() const { return path_ / "bus.sock"; }
  [[nodiscard]] std::filesystem::path control() const { return path_ / "control.sock"; }
  [[nodiscard]] std::filesystem::path link() const { return path_ / "link.sock"; }
  [[nodiscard]] std::filesystem::path black_box() const { return path_ / "black-box.sock"; }
  [[nodiscard]] std::filesystem::path audit_heads() const { return path_ / "heads.sock"; }
  [[nodiscard]] std::filesystem::path config() const { return path_ / (robot_name_ + ".ilkc"); }

 private:
  enum class Removes { nothing, own_files, everything };

  RuntimeDirectory(std::filesystem::path path, std::string robot_name)
      : path_(std::move(path)), robot_name_(std::move(robot_name)) {}

  [[nodiscard]] std::array<std::filesystem::path, 6> own_files() const {
    return {bus(), control(), link(), black_box(), audit_heads(), config()};
  }

  std::filesystem::path path_;
  std::string robot_name_;
  Removes removes_ = Removes::nothing;
};

}  // namespace interlock::cli
