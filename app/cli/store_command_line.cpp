#include "cli/store_command_line.hpp"

namespace interlock::cli {

template <typename Options>
CLI::App* StoreCommandLine::add(CLI::App* parent, const char* name, const char* description, Options& options,
                                Result<void> (*command)(const Options&, const Installation&, std::ostream&)) {
  CLI::App* const added = parent->add_subcommand(name, description);
  added->add_option("--robot", options.place.robot, "Name of a robot, or its file")->capture_default_str();
  added->add_option("--state", options.place.state,
                    "State directory; default $XDG_STATE_HOME/interlock/ROBOT");
  added->callback([this, &options, command] {
    command_ = [&options, command](const Installation& installation, std::ostream& output) {
      return command(options, installation, output);
    };
  });
  return added;
}

void StoreCommandLine::describe(CLI::App& cli) {
  describe_user(cli);
  describe_store(cli);
  describe_audit(cli);
}

void StoreCommandLine::describe_user(CLI::App& cli) {
  CLI::App* const user = cli.add_subcommand("user", "Add users, list them, change their passwords");
  user->require_subcommand(1);
  CLI::App* const added = add(user, "add", "Add a user", user_, add_user);
  added->add_option("--role", user_.role, "What the user may do: viewer, engineer or admin")
      ->required()
      ->check(CLI::IsMember({"viewer", "engineer", "admin"}));
  CLI::App* const passwd =
      add(user, "passwd", "Change a password; the user's sessions end", user_, change_password);
  for (CLI::App* const command : {added, passwd}) {
    command->add_option("NAME", user_.name, "Name of the user")->required();
    command->add_flag("--password-stdin", user_.password_from_stdin,
                      "Read the password from the standard input; default: ask at the terminal");
  }
  add(user, "list", "Show everybody", user_, list_users)->add_flag("--json", user_.json, "As JSON");
}

void StoreCommandLine::describe_store(CLI::App& cli) {
  CLI::App* const store =
      cli.add_subcommand("store", "Back up users, settings and audit, or put a backup back");
  store->require_subcommand(1);
  add(store, "backup", "Copy the store to a new file and check it; works while the robot runs", store_,
      backup)
      ->add_option("FILE", store_.file, "File to make")
      ->required();
  add(store, "restore", "Put a backup in the place of the store, which is kept beside it", store_, restore)
      ->add_option("FILE", store_.file, "Backup")
      ->required();
}

void StoreCommandLine::describe_audit(CLI::App& cli) {
  CLI::App* const audit = cli.add_subcommand("audit", "Verify, list, export or retire the audit");
  audit->require_subcommand(1);
  CLI::App* const verify =
      add(audit, "verify", "Check the whole chain of records and show its head", audit_, verify_audit);
  verify->add_option("--heads", audit_.heads,
                     "The recorder's file of noted heads; default: audit-heads among the robot's recordings");
  verify->add_flag("--json", audit_.json, "As JSON");
  verify->add_option("--file", audit_.file, "Exported records, in place of the store's")
      ->check(CLI::ExistingFile);
  verify
      ->add_option("--expect", audit_.expected_hash,
                   "A head that was noted before, which the chain must contain: shows records cut off")
      ->check(CLI::Validator(
          [](const std::string& text) {
            const bool is_hash =
                text.size() == 64 && text.find_first_not_of("0123456789abcdef") == std::string::npos;
            const bool is_none = text.find_first_not_of('0') == std::string::npos;
            return is_hash && !is_none ? std::string()
                                       : "expected 64 lower-case hex digits, not all of them 0: that is the "
                                         "hash of no record";
          },
          "HASH"));
  add(audit, "export", "Write all records into a new file, which verifies by itself", audit_, export_audit)
      ->add_option("FILE", audit_.file, "File to make")
      ->required();
  CLI::App* const retire = add(audit, "retire", "Move old records into a new file, and leave a record of it",
                               audit_, retire_audit);
  retire
      ->add_option("--keep-days", audit_.keep_days,
                   "Records of the last so many days on which something was recorded stay")
      ->required()
      ->check(CLI::Range(0, 100000));
  retire->add_option("FILE", audit_.file, "File to make")->required();
  CLI::App* const list = add(audit, "list", "Show the newest records, oldest first", audit_, list_audit);
  list->add_option("-n,--records", audit_.records, "How many")
      ->check(CLI::Range(1, 1000000))
      ->capture_default_str();
  list->add_flag("--json", audit_.json, "As JSON");
}

}  // namespace interlock::cli
