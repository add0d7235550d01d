--------------------------------- MODULE Axis ---------------------------------
(* One axis: what its card says, what it did and what that means, what requests do
   to it, what it wants, and the output gate. Operators only: `c` is the system's
   configuration, `k` the axis', `s` the system's record, `a` the axis' record.
   Homing is a module of its own.

   Fields of `a` are named as those of ilk_axis_t where both have them; raw counts are
   in the sense of the position. `fault_now` and `disabled_now` say that it happened
   in this very tick; they are FALSE between ticks. Not modelled: amplitude, which is
   bounded like drive and decides nothing else, values of faults, and totals.

   `k` has limit_side, min_counts, max_counts, home_offset_counts, coast_counts,
   deadband_counts, noise_counts, max_drive, unhomed_max_drive, unhomed_travel_counts,
   home_drive, home_slow_drive, home_travel_counts, home_clear_counts,
   home_tolerance_counts, home_timeout_ticks, switch_hysteresis_counts,
   switch_debounce_ticks, rest_ticks, stall_ticks, stall_effort_ticks, stall_min_counts,
   reverse_counts, drift_counts, max_delta_counts, required.

   A `reading` has valid (of its frame), raw, switch (TRUE: triggered) and reset (the
   card says, or its heartbeat shows, that it began anew). *)
EXTENDS Types

BlankAxis ==
  [ state |-> "DISABLED", fault |-> "NONE", fault_now |-> FALSE, disabled_now |-> FALSE,
    homed |-> "NO", card_valid |-> FALSE, card_seen |-> FALSE, bad_frames |-> 0,
    ticks_since_frame |-> 0, raw |-> 0, position_counts |-> 0,
    switch_triggered |-> FALSE, switch_ticks |-> 0, switch_raw |-> 0, switch_now |-> FALSE,
    setpoint_counts |-> 0, drive |-> 0, lease_ticks |-> 0, driven_direction |-> "NONE",
    rest |-> RunAt(0), hand |-> RunAt(0),
    stall_ticks |-> 0, stall_effort |-> 0, stall_direction |-> "NONE",
    stall_mark |-> 0, effort_mark |-> 0,
    reverse_direction |-> "NONE", reverse_mark |-> 0, drift_mark |-> 0, runaway |-> FALSE,
    travel_mark |-> 0, travel_by |-> "MOVE", move_travel |-> 0, home_travel |-> 0,
    homing_phase |-> "NONE", homing_ticks |-> 0, homing_mark |-> 0,
    first_edge |-> 0, second_edge |-> 0 ]

IsEnabled(a)     == a.state \notin {"DISABLED", "FAULTED"}
IsHomed(a)       == a.homed # "NO"
WasDriven(a)     == a.driven_direction # "NONE"
CardIsLost(c, a) == a.bad_frames >= c.bad_frame_limit

TowardsSwitch(k)  == IF k.limit_side = "UPPER" THEN "INCREASING" ELSE "DECREASING"
AwayFromSwitch(k) == IF k.limit_side = "UPPER" THEN "DECREASING" ELSE "INCREASING"

(* The switch has read one way for the debounce time. *)
ReadsTriggered(k, a) == a.switch_triggered /\ a.switch_ticks >= k.switch_debounce_ticks
ReadsOpen(k, a)      == ~a.switch_triggered /\ a.switch_ticks >= k.switch_debounce_ticks

(* Undriven, with valid frames, and no two readings farther from each other than noise. *)
IsAtRest(k, a) == a.card_valid /\ a.rest.ticks >= k.rest_ticks

-------------------------------------------------------------------------------
(* What ends motion, and faults. An axis that is not enabled has no direction to reverse. *)
DropMotion(a) ==
  [a EXCEPT !.state = IF @ \in {"MOVING", "HOMING"} THEN "ENABLED" ELSE @,
            !.setpoint_counts = 0, !.drive = 0, !.lease_ticks = 0, !.homing_phase = "NONE"]

Disabled(a) ==
  IF a.state = "FAULTED" THEN DropMotion(a)
  ELSE [DropMotion(a) EXCEPT !.state = "DISABLED", !.disabled_now = TRUE,
                             !.reverse_direction = "NONE"]

(* The first fault is kept until CLEAR_FAULT; each that says that the counter or the
   switch cannot be relied on takes the reference, whatever the state. *)
Faulted(a, fault) ==
  LET first == [DropMotion(a) EXCEPT !.state = "FAULTED", !.fault = fault, !.fault_now = TRUE,
                                     !.drift_mark = a.raw, !.reverse_direction = "NONE"]
      kept  == IF a.state = "FAULTED" THEN a ELSE first
  IN  [kept EXCEPT !.homed = IF fault = "DRIFT" THEN @ ELSE "NO"]

(* What a change of the system's mode does to every axis. A press begins with whole
   budgets. *)
BeginPress(a) ==
  [DropMotion(a) EXCEPT !.travel_mark = a.raw, !.travel_by = "MOVE", !.move_travel = 0,
                        !.home_travel = 0, !.homing_ticks = 0,
                        !.drift_mark = IF a.state = "DISABLED" THEN a.raw ELSE @]

FollowMode(before, after, a) ==
  IF before = after THEN a
  ELSE IF after = "LOCKED" THEN Disabled(a)
  ELSE IF after = "MOTION" THEN BeginPress(a)
  ELSE DropMotion(a)

-------------------------------------------------------------------------------
(* Phase 2. *)
ObserveCard(c, k, a, in, reading) ==
  [a EXCEPT !.card_valid = reading.valid,
            !.ticks_since_frame = CountBy(@, 1 + in.missed, c.bad_frame_limit + c.overrun_limit),
            !.bad_frames = IF reading.valid THEN 0 ELSE CountUp(@, c.bad_frame_limit),
            !.switch_now = k.limit_side # "NONE" /\ (reading.valid => reading.switch)]

-------------------------------------------------------------------------------
(* Phase 4: the new reading. Nothing is compared with the first one after start or
   after a lost card: whatever the counter says now, marks begin there. *)
MarksAt(a, raw) ==
  [a EXCEPT !.stall_mark = raw, !.effort_mark = raw, !.reverse_mark = raw,
            !.drift_mark = raw, !.travel_mark = raw, !.homing_mark = raw,
            !.rest = RunAt(raw), !.hand = RunAt(raw)]

FirstReading(a, raw) ==
  [MarksAt(a, raw) EXCEPT !.raw = raw, !.card_seen = TRUE, !.ticks_since_frame = 0, !.homed = "NO"]

(* A run of valid readings of the switch; a frame that is not valid neither counts nor breaks it. *)
ReadSwitch(k, a, reading) ==
  IF k.limit_side = "NONE" THEN a
  ELSE IF reading.switch = a.switch_triggered /\ a.switch_ticks > 0
       THEN [a EXCEPT !.switch_ticks = CountUp(@, k.switch_debounce_ticks)]
       ELSE [a EXCEPT !.switch_triggered = reading.switch, !.switch_ticks = 1,
                      !.switch_raw = reading.raw]

Rested(k, a, raw) ==
  IF WasDriven(a) THEN RunAt(raw) ELSE Prolonged(a.rest, raw, k.noise_counts, k.rest_ticks)

(* The path of a point that follows the counter only when it is farther away than noise. *)
Travelled(s, k, a, raw) ==
  LET path    == Magnitude(raw - a.travel_mark)
      counted == s.mode = "MOTION" /\ ~IsHomed(a)
  IN  IF ~counted THEN [a EXCEPT !.travel_mark = raw]
      ELSE IF path <= k.noise_counts THEN a
      ELSE IF a.travel_by = "HOME"
      THEN [a EXCEPT !.travel_mark = raw, !.home_travel = CountBy(@, path, k.home_travel_counts + 1)]
      ELSE [a EXCEPT !.travel_mark = raw, !.move_travel = CountBy(@, path, k.unhomed_travel_counts + 1)]

(* Progress in the direction of the marks, in any state, driven or not. *)
Progressed(k, a, raw) ==
  LET beyond(mark) == Along(a.stall_direction, raw - mark)
  IN  IF beyond(a.stall_mark) > 0 /\ beyond(a.stall_mark) >= k.stall_min_counts
      THEN [a EXCEPT !.stall_mark = raw, !.effort_mark = raw, !.stall_ticks = 0, !.stall_effort = 0]
      ELSE IF beyond(a.effort_mark) > k.noise_counts
      THEN [a EXCEPT !.effort_mark = raw, !.stall_effort = 0]
      ELSE a

AdvanceReverseMark(a, raw) ==
  IF Along(a.reverse_direction, raw - a.reverse_mark) > 0 THEN [a EXCEPT !.reverse_mark = raw] ELSE a

(* Where drift is judged from: it follows a DISABLED axis that may be moved by hand,
   and a FAULTED axis that comes to rest. *)
MovableByHand(s, a) == a.state = "DISABLED" /\ s.mode # "MOTION"

AdvanceDriftMark(s, k, a) ==
  IF MovableByHand(s, a) \/ (a.state = "FAULTED" /\ IsAtRest(k, a))
  THEN [a EXCEPT !.drift_mark = a.raw] ELSE a

Jumps(k, a, reading) ==
  Magnitude(reading.raw - a.raw) > k.max_delta_counts * a.ticks_since_frame

Reversed(k, a) == WasDriven(a) /\ -Along(a.reverse_direction, a.raw - a.reverse_mark) > k.reverse_counts
Drifted(k, a)  == ~WasDriven(a) /\ Magnitude(a.raw - a.drift_mark) > k.drift_counts

StallMet(k, a) ==
  \/ a.stall_ticks >= k.stall_ticks
  \/ k.stall_effort_ticks > 0 /\ a.stall_effort >= k.stall_effort_ticks * k.max_drive

(* An axis homed by its switch stands where the switch cannot read so. *)
FromHome(k, a) == Along(AwayFromSwitch(k), a.position_counts - k.home_offset_counts)

Implausible(k, a) ==
  LET margin == k.home_tolerance_counts + k.coast_counts
  IN  /\ a.homed = "SWITCH"
      /\ \/ ReadsTriggered(k, a) /\ FromHome(k, a) > margin + k.switch_hysteresis_counts
         \/ ReadsOpen(k, a) /\ -FromHome(k, a) > margin

(* The reading of a valid frame that is compared with the one before. *)
Followed(s, k, a, reading) ==
  LET breaks == reading.reset \/ Jumps(k, a, reading)
      moved  == [a EXCEPT !.position_counts = @ + reading.raw - a.raw, !.raw = reading.raw,
                          !.rest = Rested(k, a, reading.raw),
                          !.hand = Prolonged(@, reading.raw, k.drift_counts, k.rest_ticks)]
      anew   == [MarksAt(moved, reading.raw) EXCEPT !.homed = "NO"]
      marked == AdvanceReverseMark(Progressed(k, Travelled(s, k, moved, reading.raw), reading.raw),
                                   reading.raw)
  IN  AdvanceDriftMark(s, k, IF breaks THEN anew ELSE marked)

JudgeMotion(k, before, a, reading) ==
  IF before.card_seen /\ reading.reset THEN "CARD_RESET"
  ELSE IF before.card_seen /\ Jumps(k, before, reading) THEN "JUMP"
  ELSE IF Reversed(k, a) THEN "REVERSE"
  ELSE IF a.state # "FAULTED" /\ Drifted(k, a) THEN "DRIFT"
  ELSE IF StallMet(k, a) THEN "STALL"
  ELSE IF Implausible(k, a) THEN "SWITCH"
  ELSE "NONE"

(* A FAULTED axis that goes on moving takes power away until it rests or its card is lost. *)
JudgeRunaway(c, k, a) ==
  [a EXCEPT !.runaway = /\ a.state = "FAULTED"
                        /\ ~CardIsLost(c, a)
                        /\ ~IsAtRest(k, a)
                        /\ a.runaway \/ (a.card_valid /\ Drifted(k, a))]

RunLeaseDown(a) ==
  LET left == CountDown(a.lease_ticks)
  IN  [a EXCEPT !.lease_ticks = left,
                !.state = IF a.state = "MOVING" /\ left = 0 THEN "ENABLED" ELSE a.state]

ObserveValid(s, k, a, reading) ==
  LET switched == ReadSwitch(k, a, reading)
      followed == IF a.card_seen THEN Followed(s, k, switched, reading)
                  ELSE FirstReading(switched, reading.raw)
  IN  [ axis  |-> [followed EXCEPT !.driven_direction = "NONE", !.ticks_since_frame = 0],
        fault |-> JudgeMotion(k, a, followed, reading) ]

ObserveMissing(c, k, a) ==
  LET unread == [a EXCEPT !.driven_direction = "NONE", !.rest = RunAt(a.raw)]
  IN  IF CardIsLost(c, a)
      THEN [axis |-> [unread EXCEPT !.card_seen = FALSE, !.homed = "NO"], fault |-> "CARD"]
      ELSE [axis |-> unread, fault |-> IF StallMet(k, a) THEN "STALL" ELSE "NONE"]

Observe1(s, c, k, a, reading) ==
  LET counted == RunLeaseDown(a)
  IN  IF a.card_valid THEN ObserveValid(s, k, counted, reading) ELSE ObserveMissing(c, k, counted)

-------------------------------------------------------------------------------
(* Phase 6: the row of the request table, from left to right. A request has kind,
   target (MOVE: setpoint, RESTORE: position), drive, lease and consent. *)
PedalIsUp(s) == s.pedal = "RELEASED"

JudgeDisable(s, a) ==
  IF s.mode = "INIT" THEN "MODE"
  ELSE IF a.state = "FAULTED" THEN "FAULTED"
  ELSE "ACCEPTED"

JudgeEnable(c, k, s, a) ==
  IF s.mode \notin {"READY", "MOTION"} THEN "MODE"
  ELSE IF a.state = "FAULTED" THEN "FAULTED"
  ELSE IF ~a.card_valid THEN "CARD"
  ELSE IF IsEnabled(a) THEN "ACCEPTED"
  ELSE IF s.power_ticks < c.power_up_ticks \/ ~IsAtRest(k, a) \/ a.disabled_now THEN "BUSY"
  ELSE "ACCEPTED"

JudgeClearFault(k, s, a) ==
  IF s.mode = "INIT" THEN "MODE"
  ELSE IF a.state # "FAULTED" THEN "NO_FAULT"
  ELSE IF ~a.card_valid \/ a.fault_now \/ ~IsAtRest(k, a) \/ a.runaway THEN "CAUSE_PRESENT"
  ELSE IF ~PedalIsUp(s) THEN "PEDAL_DOWN"
  ELSE "ACCEPTED"

JudgeMayMove(s, a, request) ==
  IF s.mode # "MOTION" THEN "MODE"
  ELSE IF request.consent # s.consent THEN "CONSENT"
  ELSE IF a.state = "FAULTED" THEN "FAULTED"
  ELSE IF a.state = "DISABLED" THEN "DISABLED"
  ELSE IF a.state = "HOMING" THEN "BUSY"
  ELSE "ACCEPTED"

DriveBound(k, a) == IF IsHomed(a) THEN k.max_drive ELSE k.unhomed_max_drive

(* Where the axis may stop: one coast inside of its limits and, if its switch gave the
   reference, inside of where that opens; or of the travel that it has left in this press. *)
SoftReach(k, a) ==
  LET low     == k.min_counts + k.coast_counts
      high    == k.max_counts - k.coast_counts
      margin  == k.switch_hysteresis_counts + k.home_tolerance_counts
      opens   == k.home_offset_counts + Along(AwayFromSwitch(k), margin)
      bounded == a.homed = "SWITCH"
  IN  [low  |-> IF bounded /\ k.limit_side = "LOWER" THEN Greatest(low, opens) ELSE low,
       high |-> IF bounded /\ k.limit_side = "UPPER" THEN Least(high, opens) ELSE high]

Reach(k, a) ==
  LET left == k.unhomed_travel_counts - k.coast_counts - a.move_travel
  IN  IF IsHomed(a) THEN SoftReach(k, a)
      ELSE [low |-> a.position_counts - left, high |-> a.position_counts + left]

TowardsTriggered(k, a, target) ==
  ReadsTriggered(k, a) /\ Along(TowardsSwitch(k), target - a.position_counts) > 0

JudgeMove(c, k, s, a, request) ==
  LET may == JudgeMayMove(s, a, request)
  IN  IF may # "ACCEPTED" THEN may
      ELSE IF request.lease \notin 1..c.lease_max_ticks THEN "LEASE"
      ELSE IF request.drive \notin 1..DriveBound(k, a) THEN "DRIVE"
      ELSE IF request.target < Reach(k, a).low \/ request.target > Reach(k, a).high THEN "RANGE"
      ELSE IF TowardsTriggered(k, a, request.target) THEN "RANGE"
      ELSE "ACCEPTED"

HomingTravelLeft(k, a) == a.home_travel < k.home_travel_counts - k.coast_counts

JudgeHome(k, s, a, request) ==
  LET may == JudgeMayMove(s, a, request)
  IN  IF may # "ACCEPTED" THEN may
      ELSE IF k.limit_side = "NONE" THEN "NO_SWITCH"
      ELSE IF ~HomingTravelLeft(k, a) \/ a.homing_ticks >= k.home_timeout_ticks THEN "BUDGET"
      ELSE "ACCEPTED"

JudgeDeclare(k, s, a) ==
  IF s.mode # "READY" THEN "MODE"
  ELSE IF ~PedalIsUp(s) THEN "PEDAL_DOWN"
  ELSE IF a.state = "FAULTED" THEN "FAULTED"
  ELSE IF ~a.card_valid THEN "CARD"
  ELSE IF ~IsAtRest(k, a) THEN "BUSY"
  ELSE "ACCEPTED"

JudgeRestore(k, s, a, request) ==
  LET may == JudgeDeclare(k, s, a)
  IN  IF may = "ACCEPTED" /\ request.target \notin k.min_counts..k.max_counts THEN "RANGE" ELSE may

JudgeAxis(c, k, s, a, request) ==
  CASE request.kind = "DISABLE"     -> JudgeDisable(s, a)
    [] request.kind = "ENABLE"      -> JudgeEnable(c, k, s, a)
    [] request.kind = "CLEAR_FAULT" -> JudgeClearFault(k, s, a)
    [] request.kind = "MOVE"        -> JudgeMove(c, k, s, a, request)
    [] request.kind = "HOME"        -> JudgeHome(k, s, a, request)
    [] request.kind = "SET_HOME"    -> JudgeDeclare(k, s, a)
    [] request.kind = "RESTORE"     -> JudgeRestore(k, s, a, request)

Enabled(a) ==
  IF IsEnabled(a) THEN a ELSE [a EXCEPT !.state = "ENABLED", !.drift_mark = a.raw, !.stall_direction = "NONE"]

ClearFault(a) ==
  LET cleared == [a EXCEPT !.state = "DISABLED", !.fault = "NONE"]
  IN  IF a.fault # "STALL" THEN cleared
      ELSE [cleared EXCEPT !.stall_ticks = 0, !.stall_effort = 0,
                           !.stall_mark = a.raw, !.effort_mark = a.raw]

Move(a, request) ==
  [a EXCEPT !.state = "MOVING", !.setpoint_counts = request.target, !.drive = request.drive,
            !.lease_ticks = request.lease]

(* The run of the switch begins anew: what it read before HOME is no edge. *)
BeginHoming(a) ==
  [a EXCEPT !.state = "HOMING", !.homed = "NO", !.homing_phase = "WAIT", !.travel_by = "HOME",
            !.setpoint_counts = 0, !.drive = 0, !.lease_ticks = 0, !.switch_ticks = 0]

ApplyAxis(a, request) ==
  CASE request.kind = "DISABLE"     -> Disabled(a)
    [] request.kind = "ENABLE"      -> Enabled(a)
    [] request.kind = "CLEAR_FAULT" -> ClearFault(a)
    [] request.kind = "MOVE"        -> Move(a, request)
    [] request.kind = "HOME"        -> BeginHoming(a)
    [] request.kind = "SET_HOME"    -> [a EXCEPT !.position_counts = 0, !.homed = "HAND"]
    [] request.kind = "RESTORE"     -> [a EXCEPT !.position_counts = request.target, !.homed = "NO"]

-------------------------------------------------------------------------------
(* Phase 7: what the axis wants. *)
TowardsSetpoint(k, a) ==
  LET distance == a.setpoint_counts - a.position_counts
  IN  IF distance > k.deadband_counts THEN "INCREASING"
      ELSE IF distance < -k.deadband_counts THEN "DECREASING"
      ELSE "NONE"

WantedHoming(k, a) ==
  CASE a.homing_phase \in {"BACK_OFF", "BACK_OFF_AGAIN"} ->
         [direction |-> AwayFromSwitch(k), drive |-> k.home_drive]
    [] a.homing_phase = "APPROACH"        -> [direction |-> TowardsSwitch(k), drive |-> k.home_drive]
    [] a.homing_phase = "APPROACH_SLOWLY" -> [direction |-> TowardsSwitch(k), drive |-> k.home_slow_drive]
    [] OTHER                              -> NoDrive

WantedCommand(k, a) ==
  CASE a.state = "MOVING" -> [direction |-> TowardsSetpoint(k, a), drive |-> a.drive]
    [] a.state = "HOMING" -> WantedHoming(k, a)
    [] OTHER              -> NoDrive

(* The output gate: the first condition that blocks, "OPEN" if none does. *)
IsHeld(a) == (a.state = "MOVING" /\ a.lease_ticks # 0) \/ a.state = "HOMING"

PressesOnSwitch(k, a, direction) == a.switch_now /\ direction = TowardsSwitch(k)

LeavesSoftRange(k, a, direction) ==
  /\ IsHomed(a)
  /\ \/ direction = "INCREASING" /\ a.position_counts >= SoftReach(k, a).high
     \/ direction = "DECREASING" /\ a.position_counts <= SoftReach(k, a).low

(* Whichever way: a path, not a place, is what is left of. *)
ExceedsTravel(k, a) ==
  /\ ~IsHomed(a)
  /\ IF a.state = "HOMING" THEN ~HomingTravelLeft(k, a)
     ELSE a.move_travel >= k.unhomed_travel_counts - k.coast_counts

Gate(k, s, a, wanted) ==
  IF s.mode # "MOTION" THEN "MODE"
  ELSE IF s.pedal # "PRESSED" THEN "PEDAL"
  ELSE IF s.estop THEN "ESTOP"
  ELSE IF ~a.card_valid THEN "CARD"
  ELSE IF ~IsEnabled(a) THEN "ENABLE"
  ELSE IF ~IsHeld(a) THEN "LEASE"
  ELSE IF StallMet(k, a) THEN "STALL"
  ELSE IF wanted.direction = "NONE" \/ wanted.drive = 0 THEN "SETPOINT"
  ELSE IF PressesOnSwitch(k, a, wanted.direction) THEN "HARD_LIMIT"
  ELSE IF LeavesSoftRange(k, a, wanted.direction) THEN "SOFT_LIMIT"
  ELSE IF ExceedsTravel(k, a) THEN "TRAVEL"
  ELSE IF wanted.drive > DriveBound(k, a) THEN "DRIVE"
  ELSE "OPEN"

(* What the kernel keeps of having driven an axis. The sums of a stall go on, whatever the direction. *)
NoteDrive(k, a, command) ==
  LET way    == command.direction
      turned == a.reverse_direction # way
      anew   == a.stall_direction # way
      effort == k.stall_effort_ticks * k.max_drive
  IN  [a EXCEPT !.driven_direction = way,
                !.drift_mark = a.raw,
                !.reverse_direction = way,
                !.reverse_mark = IF turned THEN a.raw ELSE @,
                !.stall_direction = way,
                !.stall_mark = IF anew THEN a.raw ELSE @,
                !.effort_mark = IF anew THEN a.raw ELSE @,
                !.stall_ticks = CountUp(@, k.stall_ticks),
                !.stall_effort = CountBy(@, command.drive, effort),
                !.travel_by = IF a.state = "MOVING" THEN "MOVE" ELSE @]

(* In the deadband of its setpoint after an advance that no noise makes. *)
NoteArrival(k, a) ==
  IF Along(a.stall_direction, a.raw - a.stall_mark) > k.noise_counts
  THEN [a EXCEPT !.stall_mark = a.raw, !.stall_ticks = 0, !.stall_effort = 0] ELSE a

(* Phase 7 of one axis: its record, its command and what its gate says. *)
DriveAxis(k, s, a) ==
  LET wanted  == WantedCommand(k, a)
      gate    == Gate(k, s, a, wanted)
      arrived == gate = "SETPOINT" /\ a.state = "MOVING" /\ wanted.direction = "NONE"
  IN  [ axis    |-> IF gate = "OPEN" THEN NoteDrive(k, a, wanted)
                    ELSE IF arrived THEN NoteArrival(k, a) ELSE a,
        gate    |-> gate,
        command |-> IF gate = "OPEN" THEN wanted ELSE NoDrive ]
===============================================================================
