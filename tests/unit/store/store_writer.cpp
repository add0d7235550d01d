/**
 * @file
 * A process that writes to a store: `store_writer FILE COUNT`. Each transaction counts a setting up and
 * appends an audit record; once it is committed, the count stands on the standard output as a line.
 */
#include <unistd.h>

#include <iostream>
#include <string>

#include "store/audit.hpp"
#include "store/settings.hpp"
#include "store/store.hpp"

namespace interlock {
namespace {

Stored<int> write_once(Store& store, UtcTime now) {
  return store.transact([&](Transaction& transaction) -> Stored<int> {
    Settings settings(transaction);
    const auto before = settings.find("count");
    const int count = (before ? before->value.get<int>() : 0) + 1;
    settings.set("count", count, now);
    Audit(transaction)
        .append({now, std::nullopt, audit_actor::app, std::nullopt, AuditKind::setting, {{"count", count}}});
    return count;
  });
}

int run(const std::string& file, int count) {
  Stored<Store> store = Store::open(file);
  if (!store) {
    std::cerr << store.error().message() << '\n';
    return 1;
  }
  for (int number = 0; number < count; ++number) {
    const Stored<int> written = write_once(*store, std::chrono::system_clock::now());
    if (!written) {
      std::cerr << written.error().message() << '\n';
      return 1;
    }
    const std::string line = std::to_string(*written) + '\n';
    if (::write(STDOUT_FILENO, line.data(), line.size()) != static_cast<ssize_t>(line.size())) {
      return 1;
    }
  }
  return 0;
}

}  // namespace
}  // namespace interlock

int main(int argc, char** argv) { return argc == 3 ? interlock::run(argv[1], std::stoi(argv[2])) : 2; }
