#include "cli/audit_commands.hpp"

#include <nlohmann/json.hpp>

#include "store/audit.hpp"

namespace interlock::cli {

Result<void> verify_audit(const AuditOptions& options, const Installation& installation,
                          std::ostream& output) {
  Result<Store> store = open_store(options.place, installation);
  if (!store) {
    return tl::unexpected(store.error());
  }
  using Verified = tl::expected<AuditHead, AuditBreak>;
  const auto verified = store->read([&](Transaction& transaction) -> Stored<Verified> {
    return Audit(transaction).verify(options.expected_hash);
  });
  if (!verified) {
    return tl::unexpected(failure_of(verified.error()));
  }
  if (!*verified) {
    const AuditBreak& broken = verified->error();
    return failed(ExitCode::refused, "the audit is not sound: record " + std::to_string(broken.number) + ' ' +
                                         broken.problem + "; keep the file, and compare it with a backup");
  }
  output << (*verified)->number << " records, sound, head " << (*verified)->hash << '\n';
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
    output << list.dump(2) << '\n';
    return {};
  }
  for (const AuditRecord& record : *records) {
    output << record.number << ' ' << record.time << ' ' << record.actor << ' ' << record.kind << ' '
           << record.detail << '\n';
  }
  return {};
}

}  // namespace interlock::cli
