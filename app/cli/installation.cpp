#include "cli/installation.hpp"

#include <unistd.h>

namespace interlock::cli {

namespace fs = std::filesystem;

Installation Installation::current() {
  const fs::path programs = fs::read_symlink("/proc/self/exe").parent_path();
  return {programs, {programs.parent_path() / "share/interlock", INTERLOCK_SOURCE_DIR}};
}

Result<fs::path> Installation::program(const std::string& name) const {
  fs::path file = programs_ / name;
  if (access(file.c_str(), X_OK) != 0) {
    return failed(ExitCode::precondition, "there is no program " + file.string() +
                                              "; expected it beside interlock: build or install all of it");
  }
  return file;
}

Result<fs::path> Installation::robot(const std::string& robot) const {
  if (robot.ends_with(".toml") || robot.find('/') != std::string::npos) {
    return fs::path(robot);
  }
  return model("robots", robot);
}

std::vector<fs::path> Installation::robots() const {
  std::vector<fs::path> files;
  for (const fs::path& root : roots_) {
    std::error_code none;
    for (const fs::directory_entry& entry : fs::directory_iterator(root / "models/robots", none)) {
      if (entry.path().extension() == ".toml") {
        files.push_back(entry.path());
      }
    }
  }
  return files;
}

Result<fs::path> Installation::plant(const std::string& robot_name) const {
  return model("plant", robot_name);
}

Result<fs::path> Installation::model(const std::string& kind, const std::string& name) const {
  std::string looked;
  for (const fs::path& root : roots_) {
    fs::path file = root / "models" / kind / (name + ".toml");
    if (fs::exists(file)) {
      return file;
    }
    looked += (looked.empty() ? "" : " and ") + file.string();
  }
  return failed(ExitCode::precondition,
                "there is no " + kind + " file for \"" + name + "\"; looked for " + looked);
}

std::optional<fs::path> Installation::web() const {
  for (const fs::path& root : roots_) {
    for (const char* const folder : {"web", "web/dist"}) {
      if (fs::exists(root / folder / "assets")) {
        return root / folder;
      }
    }
  }
  return std::nullopt;
}

std::optional<fs::path> Installation::documents() const {
  for (const fs::path& root : roots_) {
    for (const char* const folder : {"documents", "build/docs/site"}) {
      if (fs::exists(root / folder / "index.html")) {
        return root / folder;
      }
    }
  }
  return std::nullopt;
}

}  // namespace interlock::cli
