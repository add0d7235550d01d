
#include <chrono>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "cli/commands.hpp"
#include "store/audit.hpp"
#include "store/audit_check.hpp"
#include "store/audit_file.hpp"
#include "store/audit_verdict.hpp"
#include "store/noted_heads.hpp"
#include "system/printable.hpp"

namespace interlock::cli {

namespace {

namespace fs = std::filesystem;
using Verified = tl::expected<AuditHead, AuditBreak>;

Failure not_sound(const AuditBreak& broken) {
  return {ExitCode::refused, "the audit is not sound: record " + std::to_string(broken.number) + ' ' +
                                 printable(broken.problem) + "; keep the file, and compare it with a backup"};
}

/** The verdict; refused where a record that excuses noted heads is not proven. */
Result<void> tell(const AuditVerdict& verdict, bool json, std::ostream& output) {
  if (json) {
    // As ASCII: a terminal shows it, too.
    output << to_json(verdict).dump(2, ' ', true, nlohmann::json::error_handler_t::replace) << '\n';
  }
  if (!is_proven(verdict)) {
    return failed(
        ExitCode::refused,
        "the audit is not proven: " + text_of(verdict) +
            "; see that somebody did this, and compare with a backup or the files of retired records");
  }
  if (!json) {
    output << text_of(verdict) << '\n';
  }
  return {};
}

/** The verdict on a chain that was checked. */
Result<AuditVerdict> verdict_on(const Stored<Verified>& verified, std::optional<ComparedHeads> heads) {
  if (!verified) {
    return tl::unexpected(failure_of(verified.error()));
  }
  if (!*verified) {
    return tl::unexpected(not_sound(verified->error()));
  }
  return AuditVerdict{**verified, std::move(heads)};
}

/** In parts: the log of the writers is emptied between them. */
Stored<Verified> verify_in_parts(Store& store, AuditCheck& check) {
  for (bool more = true; more;) {
    const Stored<bool> gone_on = check_part(store, check);
    if (!gone_on) {
      return tl::unexpected(gone_on.error());
    }
    more = *gone_on;
  }
  return check.result();
}

/** The records that are to go, in their file; the last of them. Nothing when there are none. */
Stored<std::optional<AuditHead>> move_out(Transaction& transaction, const AuditOptions& options) {
  const Audit audit(transaction);
  const std::vector<AuditRecord> old = audit.before_last_days(static_cast<int>(options.keep_days));
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
    return verdict_on(verify_audit_file(options.file, options.expected_hash), std::nullopt)
        .and_then([&](const AuditVerdict& verdict) { return tell(verdict, options.json, output); });
  }
  Result<Store> store = open_store(options.place, installation);
  if (!store) {
    return tl::unexpected(store.error());
  }
  const Result<fs::path> state = state_of(options.place, installation);
  const fs::path file = options.heads.empty() ? heads_file(*state) : options.heads;
  const Stored<NotedHeads> heads = read_noted_heads(file);
  if (!heads) {
    return tl::unexpected(failure_of(heads.error()));
  }
  AuditCheck check(options.expected_hash, *heads);
  const Stored<Verified> verified = verify_in_parts(*store, check);
  return verdict_on(verified, compared_heads(check, file, heads->size(), *state / store_file_name))
      .and_then([&](const AuditVerdict& verdict) { return tell(verdict, options.json, output); });
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
    auto last = move_out(transaction, options);
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
    output << "no record is older than the last " << options.keep_days
           << " days on which something was recorded\n";
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
