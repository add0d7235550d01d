#include "cli/announcement.hpp"

namespace interlock::cli {

void announce(const Announcement& announcement, std::ostream& output) {
  const std::string line(60, '=');
  output << '\n'
         << line << "\n  " << announcement.what << "\n\n  "
         << (announcement.console ? "Open " + announcement.url
                                  : "HTTP API at " + announcement.url + "; the console is not built")
         << (announcement.first_login.empty()
                 ? ""
                 : "\n\n  First login, shown only now (user, password):\n  " + announcement.first_login)
         << "\n\n  Ctrl-C stops everything.\n"
         << line << "\n\nready " << announcement.url << std::endl;
}

}  // namespace interlock::cli
