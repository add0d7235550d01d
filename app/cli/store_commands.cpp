#include "cli/commands.hpp"
#include "cli/instance_lock.hpp"
#include "store/noted_heads.hpp"
#include "store/store_backup.hpp"
#include "system/utc_time.hpp"

namespace interlock::cli {
namespace {

namespace fs = std::filesystem;

std::string text_of(const StoreSummary& summary) {
  return std::to_string(summary.users) + " users, " + std::to_string(summary.head.number) +
         " audit records, head " + summary.head.hash;
}

}  // namespace

Result<void> backup(const StoreOptions& options, const Installation& installation, std::ostream& output) {
  const Result<fs::path> store = store_file(options.place, installation);
  if (!store) {
    return tl::unexpected(store.error());
  }
  const Stored<StoreSummary> summary = backup_store(*store, options.file);
  if (!summary) {
    return tl::unexpected(failure_of(summary.error()));
  }
  output << options.file.string() << ": " << text_of(*summary) << '\n';
  return {};
}

Result<void> restore(const StoreOptions& options, const Installation& installation, std::ostream& output) {
  const Result<fs::path> state = state_of(options.place, installation);
  if (!state) {
    return tl::unexpected(state.error());
  }
  const Result<InstanceLock> lock = InstanceLock::take(*state);
  if (!lock) {
    return tl::unexpected(lock.error());
  }
  const fs::path store = *state / store_file_name;
  const fs::path heads_noted = heads_file(*state);
  Stored<NotedHeads> heads = read_noted_heads(heads_noted);
  if (!heads) {
    return tl::unexpected(failure_of(heads.error()));
  }
  const bool excuses_heads = !heads->empty();
  const UtcTime now = std::chrono::system_clock::now();
  const Stored<Restored> restored = restore_store(options.file, store, now, std::move(*heads));
  if (!restored) {
    return tl::unexpected(failure_of(restored.error()));
  }
  output << store.string() << ": " << text_of(restored->summary) << '\n';
  if (restored->replaced) {
    output << "what was there before is " << restored->replaced->string() << '\n';
  }
  if (excuses_heads && !note_head(heads_noted, {iso_8601(now), restored->summary.head})) {
    output << "this user cannot note the head in " << heads_noted.string()
           << ": until the next start has, `audit verify` does not call the restore proven\n";
  }
  return {};
}

}  // namespace interlock::cli
