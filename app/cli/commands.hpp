/**
 * @file
 * The commands of `interlock`, each with its options. `interlock run` has a header of its own.
 */
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iosfwd>
#include <istream>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "calibration/calibration.hpp"
#include "cli/exit_code.hpp"
#include "cli/installation.hpp"
#include "cli/kinematics_lines.hpp"
#include "cli/replay_views.hpp"
#include "cli/store_place.hpp"
#include "interlock/types.h"
#include "robot/robot.hpp"
#include "trajectory/trajectory_builder.hpp"
#include "tuning/step_run.hpp"

namespace interlock::cli {

/** `interlock audit verify|list|export|retire`. */
struct AuditOptions {
  StorePlace place;
  std::optional<std::string> expected_hash; /**< a head that was noted before */
  std::filesystem::path heads;              /**< that the recorder noted; empty: those of the state */
  std::size_t records = 20;
  bool json = false;
  std::filesystem::path file; /**< exported records: to verify, or to make */
  std::uint32_t keep_days = 0;
};

/** Goes over the whole chain, compares it with the heads that the recorder noted and with the users, and
 * shows its head; refused, with the place, where something differs, or where a record that excuses noted
 * heads is not proven. */
Result<void> verify_audit(const AuditOptions& options, const Installation& installation,
                          std::ostream& output);

/** Writes all records into a file, which verifies by itself. */
Result<void> export_audit(const AuditOptions& options, const Installation& installation,
                          std::ostream& output);

/** Moves the records older than `keep_days` into a file, and leaves a record of it. Refused where the chain
 * is broken. */
Result<void> retire_audit(const AuditOptions& options, const Installation& installation,
                          std::ostream& output);

/** The newest records, oldest first. */
Result<void> list_audit(const AuditOptions& options, const Installation& installation, std::ostream& output);

}  // namespace interlock::cli

namespace CLI {

// `interlock igtl`: speaks OpenIGTLink to a robot, or to any other program that listens, for trying things
// out.
class App;
}  // namespace CLI

namespace interlock::cli {

/** What the command of igtl is asked for. */
struct IgtlOptions {
  std::string host = "127.0.0.1";
  std::uint16_t port = 18944;
  double seconds = 0.0; /**< how long is waited; each command has its own default */
  bool json = false;
  std::string type;                /**< of `send` */
  std::string name;                /**< of `send`: device name */
  std::vector<std::string> values; /**< of `send` */
  std::string only;                /**< of `listen`: a name, or all */
  std::uint32_t count = 0;         /**< of `listen`: ends after as many; 0: never */
  std::vector<std::string> phases; /**< of `phase` */
  std::string id = "1";            /**< of `phase` */
};

/** Adds `igtl` with its `send`, `listen` and `phase` to the command line. */
void add_igtl(CLI::App& cli, IgtlOptions& options);

/** Carries out what was chosen of them. */
Result<void> speak_igtl(const CLI::App& chosen, const IgtlOptions& options, std::ostream& output);

/**
 * `interlock kinematics fk|ik`: one JSON object a line in, one out, for scripts and for checking against
 * other implementations. docs/kinematics.md describes the objects.
 */
struct KinematicsOptions {
  std::string robot; /**< name of a robot, or its file */
  std::vector<std::string>
      settings; /**< KEY=VALUE in place of what the file says in [kinematics] and [probe] */
};

/**
 * Answers every line, also bad ones, with an object of its own, until the input ends.
 *
 * @return USAGE for a setting that is not understood, REFUSED for a robot whose geometry cannot work and,
 * once the input has ended, when a line had no answer.
 */
Result<void> answer_kinematics(KinematicsTask task, const KinematicsOptions& options,
                               const Installation& installation, std::istream& input, std::ostream& output);

/** `interlock calibrate`: kinematics from measured poses. docs/calibration.md describes table and answer. */
struct CalibrateOptions {
  std::string robot;           /**< name of a robot, or its file */
  std::filesystem::path poses; /**< the table */
  std::filesystem::path write; /**< where the robot's file with what was found goes; empty: nowhere */
  std::vector<std::uint32_t> leave_out; /**< lines of the table that do not count */
  CalibrationOptions fit;
};

/**
 * Fits the numbers, writes the robot's file with them, and answers with one line of JSON.
 *
 * @return REFUSED for a table or a robot that cannot be calibrated, for `write` while a pose is an outlier, and for
 * numbers with which the kernel would refuse the robot; USAGE for a line that the table does not have;
 * PRECONDITION when a file cannot be read or written.
 */
Result<void> calibrate(const CalibrateOptions& options, const Installation& installation,
                       std::ostream& output);

// `interlock model check` and `interlock model compile`.

/** A robot and the configuration that the kernel accepted. */
struct CompiledRobot {
  Robot robot;
  ilk_config_t config;
};

/** Reads and compiles a robot file. */
Result<CompiledRobot> load_and_compile(const std::filesystem::path& file);

/** Says whether the robot file is sound, and what the robot consists of; `json`: in one JSON object. */
Result<void> check_model(const std::filesystem::path& file, bool json, std::ostream& output);

/** Writes the configuration to `config_file`, by default NAME.ilkc in the working directory. */
Result<void> compile_model(const std::filesystem::path& file, const std::filesystem::path& config_file,
                           std::ostream& output);

/** Writes the configuration to a file. */
Result<void> save_config(const ilk_config_t& config, const std::filesystem::path& file);

/** `interlock record`: writes out what the black box of a running kernel holds. */
struct RecordOptions {
  StorePlace place;
  std::filesystem::path black_box; /**< socket; empty: that of `interlock run` with this robot and state */
  std::filesystem::path file; /**< empty: a new one among the robot's recordings, or here with `black_box` */
  std::uint32_t seconds = 60; /**< of kernel time */
};

/** The folder of a robot's recordings. */
std::filesystem::path recordings_folder(const std::filesystem::path& state);

/** PRECONDITION when there is no black box, or the file cannot be written or is there already. */
Result<void> record(const RecordOptions& options, const Installation& installation, std::ostream& output);

/** `interlock replay`: runs the kernel core again on a recording. */
struct ReplayOptions {
  std::filesystem::path file;
  std::filesystem::path csv;  /**< a row a tick; empty: none */
  std::filesystem::path plot; /**< positions, drives and mode as SVG; empty: none */
  bool judge = false;         /**< have the monitors judge each tick */
  bool console = false;       /**< show it in the console, until a signal */
  ReplayShow show;            /**< how */
};

/**
 * Says "identical", or names the first bit that comes out differently; if asked, names the first tick that
 * breaks a property, or says by how many monitors how many ticks were judged; then, if asked, shows in the
 * console what is identical.
 *
 * @return REFUSED for a difference, a broken property, a damaged file, or one of another release; PRECONDITION when a file cannot
 * be read or written.
 */
Result<void> replay(const ReplayOptions& options, std::ostream& output);

/** `interlock status`: the system at a glance. */
struct StatusOptions {
  std::uint16_t port = 8080;
  bool json = false; /**< the app's answer as it came */
};

/** Asks the app on this machine and writes a table for people, or JSON, to `output`. */
Result<void> show_status(const StatusOptions& options, std::ostream& output);

/** The table of a `Status` of spec/openapi.yaml. */
Result<std::string> status_table(const std::string& body);

/** `interlock store backup|restore`. */
struct StoreOptions {
  StorePlace place;
  std::filesystem::path file;
};

/** Copies the store to a new file, also while the app runs, and checks the copy. */
Result<void> backup(const StoreOptions& options, const Installation& installation, std::ostream& output);

/** Puts a backup in the place of the store, which is kept beside it. Refused while an instance runs. */
Result<void> restore(const StoreOptions& options, const Installation& installation, std::ostream& output);

/**
 * `interlock trajectory check`: whether a robot can follow a trajectory that is written in a file, and where
 * it leads. docs/trajectories.md describes file and answer.
 */
struct TrajectoryOptions {
  std::string robot; /**< name of a robot, or its file */
  std::filesystem::path file;
  Timing timing = Timing::as_written;
};

/**
 * Answers with one JSON object: rows, duration and reach of the axes, or the error.
 *
 * @return USAGE for a velocity that is not understood, PRECONDITION when the file cannot be read, REFUSED for a
 * trajectory that the robot cannot follow.
 */
Result<void> check_trajectory(const TrajectoryOptions& options, const Installation& installation,
                              std::ostream& output);

/** An axis of a robot on its simulated hardware. */
struct SimulatedAxis {
  std::string robot;           /**< name of a robot, or its file */
  std::filesystem::path plant; /**< parameters of the simulated hardware; empty: those of the robot */
  std::filesystem::path svg;   /**< where the plot goes; empty: nowhere */
  std::filesystem::path write; /**< where the robot's file with what was found goes; empty: nowhere */
};

/**
 * `interlock tune`: a step of one axis, as figures, table and plot. docs/tuning.md describes command and
 * figures.
 */
struct TuneOptions : SimulatedAxis {
  StepOptions step;
  std::filesystem::path csv; /**< where the table goes; empty: nowhere */
};

/**
 * Writes table and plot and, with the best gains that a search finds, the robot's file; then answers with one
 * line of JSON, about a step with those gains.
 *
 * @return REFUSED for an axis, a move or gains that the robot cannot follow, and when a fault ended the motion;
 * PRECONDITION when a file cannot be read or written.
 */
Result<void> tune(const TuneOptions& options, const Installation& installation, std::ostream& output);

/** `interlock identify`: what the mechanics of one axis do, measured. docs/tuning.md describes it. */
struct IdentifyOptions : SimulatedAxis {
  std::string axis;
  std::uint64_t seed = 1; /**< of the plant's noise */
};

/**
 * Writes the plot and the robot's file with what was measured, then answers with one line of JSON.
 *
 * @return REFUSED for an axis that cannot be measured, when a fault ended the motion, and for measured numbers
 * with which the kernel would refuse the robot; PRECONDITION when a file cannot be read or written.
 */
Result<void> identify(const IdentifyOptions& options, const Installation& installation, std::ostream& output);

/** `interlock user add|passwd|list`. They work while the app runs, on the same store. */
struct UserOptions {
  StorePlace place;
  std::string name;
  std::string role;
  bool password_from_stdin = false;
  bool json = false;
};

/** Adds a user; the store is made if there is none. */
Result<void> add_user(const UserOptions& options, const Installation& installation, std::ostream& output);

/** Gives a user a new password and ends the sessions of the user. */
Result<void> change_password(const UserOptions& options, const Installation& installation,
                             std::ostream& output);

Result<void> list_users(const UserOptions& options, const Installation& installation, std::ostream& output);

}  // namespace interlock::cli
