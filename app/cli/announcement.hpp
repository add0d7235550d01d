/**
 * @file
 * What is said when a robot, or a recording of one, can be looked at.
 */
#pragma once

#include <ostream>
#include <string>

namespace interlock::cli {

struct Announcement {
  std::string what;        /**< runs */
  std::string url;         /**< at which the app answers */
  bool console = false;    /**< it shows the console there, too */
  std::string first_login; /**< user and password; empty when there is no need for them */
};

/** Says it so that it is seen among the output of the processes, and ends with a line "ready URL". */
void announce(const Announcement& announcement, std::ostream& output);

}  // namespace interlock::cli
