/**
 * @file
 * `interlock igtl`: speaks OpenIGTLink to a robot, or to any other program that listens, for trying things
 * out.
 */
#pragma once

#include <cstdint>
#include <iosfwd>
#include <string>
#include <vector>

#include "cli/exit_code.hpp"

namespace CLI {
class App;
}

namespace interlock::cli {

struct IgtlOptions {
  std::string host = "127.0.0.1";
  std::uint16_t port = 18944;
  double seconds = 0.0; /**< how long is waited; each command has its own default */
  bool json = false;
  std::string type;                /**< of `send` */
  std::string name;                /**< of `send`: device name */
  std::vector<std::string> values; /**< of `send` */
  std::string only;                /**< of `listen`: a name, or all */
  std::uint32_t count = 0;         /**< of `listen`: ends after as many; 0: never */
  std::vector<std::string> phases; /**< of `phase` */
  std::string id = "1";            /**< of `phase` */
};

/** Adds `igtl` with its `send`, `listen` and `phase` to the command line. */
void add_igtl(CLI::App& cli, IgtlOptions& options);

/** Carries out what was chosen of them. */
Result<void> speak_igtl(const CLI::App& chosen, const IgtlOptions& options, std::ostream& output);

}  // namespace interlock::cli
