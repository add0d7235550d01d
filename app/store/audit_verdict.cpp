#include "store/audit_verdict.hpp"

#include <sys/stat.h>

#include <algorithm>

#include "store/schema.hpp"
#include "system/printable.hpp"

namespace interlock {
namespace {

using nlohmann::json;

std::string counted_heads(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " head" : " heads");
}

/** "; 3 heads are not compared: record 30 (restore, store, TIME, command line, root (0)) excuses them". */
std::string text_of(const HeadExcuse& excuse) {
  const ExcusingRecord& record = excuse.record;
  std::string text = "; " + counted_heads(excuse.heads) + (excuse.heads == 1 ? " is" : " are") +
                     " not compared, but excused by record " + std::to_string(record.number) + " (" +
                     record.kind;
  for (const std::string& part : {record.action, record.time, record.actor, record.os_user}) {
    text += part.empty() ? "" : ", " + part;
  }
  return text + ')' + (excuse.doubt.empty() ? "" : ", which is not proven: " + excuse.doubt);
}

std::string text_of(const ComparedHeads& heads) {
  const HeadComparison& comparison = heads.comparison;
  if (heads.noted == 0) {
    return "not compared with noted heads, of which " +
           (heads.file.empty() ? "this machine keeps none" : "there are none in " + heads.file.string()) +
           ": records cut off or written anew do not show";
  }
  std::string text = comparison.compared == 0
                         ? "compared with none of the " + counted_heads(heads.noted)
                         : "in agreement with the " + counted_heads(comparison.compared) + " up to record " +
                               std::to_string(comparison.up_to);
  text += " that the recorder noted in " + heads.file.string() +
          (heads.same_owner ? ", which the store's owner can change, too" : "");
  for (const HeadExcuse& excuse : comparison.excuses) {
    text += text_of(excuse);
  }
  return text;
}

json to_json(const HeadExcuse& excuse) {
  const ExcusingRecord& record = excuse.record;
  return {{"heads", excuse.heads},
          {"record", record.number},
          {"kind", record.kind},
          {"action", record.action},
          {"time", record.time},
          {"actor", record.actor},
          {"os_user", record.os_user},
          {"proven", excuse.doubt.empty()},
          {"doubt", excuse.doubt.empty() ? json() : json(excuse.doubt)}};
}

json to_json(const ComparedHeads& heads) {
  json excused = json::array();
  for (const HeadExcuse& excuse : heads.comparison.excuses) {
    excused.push_back(to_json(excuse));
  }
  return {{"summary", printable(text_of(heads))},
          {"file", heads.file.empty() ? json() : json(heads.file.string())},
          {"noted", heads.noted},
          {"compared", heads.comparison.compared},
          {"up_to", heads.comparison.compared == 0 ? json() : json(heads.comparison.up_to)},
          {"same_owner", heads.same_owner},
          {"excused", std::move(excused)}};
}

/** Whether the store's owner can change the file of noted heads. */
bool have_same_owner(const std::filesystem::path& file, const std::filesystem::path& store) {
  struct stat noted{};
  struct stat kept{};
  return ::stat(file.c_str(), &noted) != 0 || ::stat(store.c_str(), &kept) != 0 ||
         noted.st_uid == kept.st_uid;
}

}  // namespace

Stored<bool> check_part(Store& store, AuditCheck& check) {
  constexpr std::size_t part = 2000;
  return store.read([&](Transaction& transaction) -> Stored<bool> {
    const bool more = check.go_on(transaction.database(), part);
    // Last: a record that was changed behind a trigger that was dropped is named first.
    return more || !check.result() ? more
                                   : check_definitions(transaction.database()).map([] { return false; });
  });
}

ComparedHeads compared_heads(const AuditCheck& check, std::filesystem::path file, std::size_t noted,
                             const std::filesystem::path& store) {
  const bool same_owner = have_same_owner(file, store);
  return {std::move(file), noted, check.comparison(), same_owner};
}

bool is_proven(const AuditVerdict& verdict) {
  return !verdict.heads || std::ranges::all_of(verdict.heads->comparison.excuses,
                                               [](const HeadExcuse& each) { return each.doubt.empty(); });
}

std::string text_of(const AuditVerdict& verdict) {
  return std::to_string(verdict.head.number) + " records, an unbroken chain, " +
         printable(verdict.heads ? text_of(*verdict.heads)
                                 : "not compared with noted heads, as a file stands for itself") +
         ", head " + verdict.head.hash;
}

json to_json(const AuditVerdict& verdict) {
  return {{"records", verdict.head.number},
          {"head", verdict.head.hash},
          {"proven", is_proven(verdict)},
          {"noted_heads", verdict.heads ? to_json(*verdict.heads) : json()}};
}

}  // namespace interlock
