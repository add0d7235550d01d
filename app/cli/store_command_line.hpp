/**
 * @file
 * Options of `interlock user`, `interlock store` and `interlock audit`.
 */
#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <ostream>

#include "cli/commands.hpp"

namespace interlock::cli {

/** The part of the command line that works on the store. */
class StoreCommandLine {
 public:
  StoreCommandLine() = default;
  StoreCommandLine(const StoreCommandLine&) = delete;
  StoreCommandLine& operator=(const StoreCommandLine&) = delete;

  /** Adds the commands to `cli`, which is parsed while this lives. */
  void describe(CLI::App& cli);

  /** One of these commands was given. */
  [[nodiscard]] bool chosen() const { return command_ != nullptr; }

  /** Does what was given. */
  [[nodiscard]] Result<void> execute(const Installation& installation, std::ostream& output) const {
    return command_(installation, output);
  }

 private:
  using Command = std::function<Result<void>(const Installation&, std::ostream&)>;

  template <typename Options>
  CLI::App* add(CLI::App* parent, const char* name, const char* description, Options& options,
                Result<void> (*command)(const Options&, const Installation&, std::ostream&));

  void describe_user(CLI::App& cli);
  void describe_store(CLI::App& cli);
  void describe_audit(CLI::App& cli);

  UserOptions user_;
  StoreOptions store_;
  AuditOptions audit_;
  Command command_;
};

}  // namespace interlock::cli
