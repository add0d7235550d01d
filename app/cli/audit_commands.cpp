#include "cli/audit_commands.hpp"

#include <chrono>
#include <limits>
#include <nlohmann/json.hpp>

#include "store/audit.hpp"
#include "store/audit_file.hpp"
#include "text/printable.hpp"

namespace interlock::cli {

namespace {

using Verified = tl::expected<AuditHead, AuditBreak>;

Failure not_sound(const AuditBreak& broken) {
  return {ExitCode::refused, "the audit is not sound: record " + std::to_string(broken.number) + ' ' +
                                 printable(broken.problem) + "; keep the file, and compare it with a backup"};
}

Result<void> tell(const Stored<Verified>& verified, std::ostream& output) {
  if (!verified) {
    return tl::unexpected(failure_of(verified.error()));
  }
  if (!*verified) {
    return tl::unexpected(not_sound(verified->error()));
  }
  output << (*verified)->number << " records, sound, head " << (*verified)->hash << '\n';
  return {};
}

/** The records that are to go, in their file; the last of them. Nothing when there are none. */
Stored<std::optional<AuditHead>> move_out(Transaction& transaction, const AuditOptions& options,
                                          UtcTime until) {
  const Audit audit(transaction);
  const std::vector<AuditRecord> old = audit.older_than(until);
  if (old.empty()) {
    return std::nullopt;
  }
  if (const Stored<void> written = write_audit_file(options.file, audit.anchor(), old); !written) {
    return tl::unexpected(written.error());
  }
  return AuditHead{old.back().number, old.back().hash};
}

}  // namespace

Result<void> verify_audit(const AuditOptions& options, const Installation& installation,
                          std::ostream& output) {
  if (!options.file.empty()) {
    return tell(verify_audit_file(options.file, options.expected_hash), output);
  }
  Result<Store> store = open_store(options.place, installation);
  if (!store) {
    return tl::unexpected(store.error());
  }
  return tell(store->read([&](Transaction& transaction) -> Stored<Verified> {
    return Audit(transaction).verify(options.expected_hash);
  }),
              output);
}

Result<void> export_audit(const AuditOptions& options, const Installation& installation,
                          std::ostream& output) {
  Result<Store> store = open_store(options.place, installation);
  if (!store) {
    return tl::unexpected(store.error());
  }
  const auto count = store->read([&](Transaction& transaction) -> Stored<std::size_t> {
    const Audit audit(transaction);
    const std::vector<AuditRecord> records = audit.list(std::numeric_limits<std::int64_t>::max());
    return write_audit_file(options.file, audit.anchor(), records).map([&] { return records.size(); });
  });
  if (!count) {
    return tl::unexpected(failure_of(count.error()));
  }
  output << *count << " records in " << options.file.string() << '\n';
  return {};
}

Result<void> retire_audit(const AuditOptions& options, const Installation& installation,
                          std::ostream& output) {
  Result<Store> store = open_store(options.place, installation);
  if (!store) {
    return tl::unexpected(store.error());
  }
  const UtcTime now = std::chrono::system_clock::now();
  Verified sound;
  const auto retired = store->transact([&](Transaction& transaction) -> Stored<std::optional<AuditHead>> {
    Audit audit(transaction);
    sound = audit.verify();
    if (!sound) {
      return std::nullopt;
    }
    auto last = move_out(transaction, options, now - std::chrono::days(options.keep_days));
    if (last && *last) {
      audit.retire(**last, {.time = now,
                            .tick = std::nullopt,
                            .actor = audit_actor::command_line,
                            .session = std::nullopt,
                            .detail = {{"file", options.file.filename().string()}}});
    }
    return last;
  });
  if (!retired) {
    return tl::unexpected(failure_of(retired.error()));
  }
  if (!sound) {
    return tl::unexpected(not_sound(sound.error()));
  }
  if (!*retired) {
    output << "no record is older than " << options.keep_days << " days\n";
    return {};
  }
  output << "records up to " << (*retired)->number << " are in " << options.file.string()
         << ", the audit begins behind " << (*retired)->hash << '\n';
  return {};
}

Result<void> list_audit(const AuditOptions& options, const Installation& installation, std::ostream& output) {
  Result<Store> store = open_store(options.place, installation);
  if (!store) {
    return tl::unexpected(store.error());
  }
  const auto records = store->read([&](Transaction& transaction) -> Stored<std::vector<AuditRecord>> {
    return Audit(transaction).list(options.records);
  });
  if (!records) {
    return tl::unexpected(failure_of(records.error()));
  }
  if (options.json) {
    nlohmann::json list = nlohmann::json::array();
    for (const AuditRecord& record : *records) {
      list.push_back(to_json(record));
    }
    // As ASCII: a terminal shows it, too.
    output << list.dump(2, ' ', true) << '\n';
    return {};
  }
  for (const AuditRecord& record : *records) {
    output << record.number << ' '
           << printable(record.time + ' ' + record.actor + ' ' + record.kind + ' ' + record.detail) << '\n';
  }
  return {};
}

}  // namespace interlock::cli
