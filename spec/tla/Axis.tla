--------------------------------- MODULE Axis ---------------------------------
(* One axis: what its card says, what it did and what that means, what requests do
   to it, what it wants, and the output gate. Operators only: `c` is the system's
   configuration, `k` the axis', `s` the system's record, `a` the axis' record.

   Fields of `a` are those of ilk_axis_t, with these changes. Only differences of
   raw counts matter, so that a mark (stall_mark_raw and so on) is kept as the
   travel since it, in the sense of the position: since_stall_mark is the travel
   from stall_mark_raw to raw. `fault_now` stands for fault_tick = tick; it is
   FALSE between ticks. Not modelled: amplitude, which is bounded like drive but
   never decides anything else, fault_value, heartbeat, card_time_us, card_status
   and totals since boot.

   `k` has limit_side, min_counts, max_counts, home_offset_counts, coast_counts,
   deadband_counts, max_drive, unhomed_max_drive, unhomed_travel_counts,
   home_drive, home_travel_counts, home_backoff_counts, home_timeout_ticks,
   home_rest_ticks, stall_ticks, stall_min_counts, reverse_counts, drift_counts,
   settle_ticks, max_delta_counts, required.

   A `reading` has frame (Frames), moved (travel of the counter since the last
   valid frame, in the sense of the position) and switch (TRUE: triggered). *)
EXTENDS Types

BlankAxis ==
  [ state |-> "DISABLED", fault |-> "NONE", fault_now |-> FALSE, homed |-> FALSE,
    switch_triggered |-> FALSE, card_valid |-> FALSE, card_seen |-> FALSE,
    bad_frames |-> 0, ticks_since_frame |-> 0, position_counts |-> 0,
    delta_counts |-> 0, setpoint_counts |-> 0, drive |-> 0, lease_ticks |-> 0,
    driven_direction |-> "NONE", press_travel_counts |-> 0,
    stall_driven_ticks |-> 0, since_stall_mark |-> 0, stall_direction |-> "NONE",
    setpoint_changed |-> FALSE, since_reverse_mark |-> 0,
    reverse_direction |-> "NONE", since_drift_mark |-> 0, undriven_ticks |-> 0,
    homing_phase |-> "NONE", homing_ticks |-> 0, since_homing_mark |-> 0,
    rest_ticks |-> 0 ]

IsEnabled(a)   == a.state \notin {"DISABLED", "FAULTED"}
WasDriven(a)   == a.driven_direction # "NONE"
CardIsLost(c, a) == a.bad_frames >= c.bad_frame_limit

-------------------------------------------------------------------------------
(* What ends motion, and faults. *)
DropMotion(a) ==
  [a EXCEPT !.state = IF a.state \in {"MOVING", "HOMING"} THEN "ENABLED" ELSE a.state,
            !.setpoint_counts = 0, !.drive = 0, !.lease_ticks = 0,
            !.homing_phase = "NONE",
            !.setpoint_changed = a.setpoint_changed \/ a.stall_driven_ticks # 0]

Disabled(a) ==
  LET dropped == DropMotion(a)
  IN  IF a.state = "FAULTED" THEN dropped ELSE [dropped EXCEPT !.state = "DISABLED"]

(* After these the counter no longer tells where the axis is. *)
LosesReference(fault) == fault \in {"JUMP", "CARD_LOST", "HOMING_TRAVEL", "HOMING_TIMEOUT"}

(* The first fault is kept until CLEAR_FAULT. *)
Faulted(a, fault) ==
  LET first == [DropMotion(a) EXCEPT !.state = "FAULTED", !.fault = fault, !.fault_now = TRUE]
      kept  == IF a.state = "FAULTED" THEN a ELSE first
  IN  [kept EXCEPT !.homed = kept.homed /\ ~LosesReference(fault)]

(* What a change of the system's mode does to every axis. *)
FollowMode(before, after, a) ==
  IF before = after THEN a
  ELSE IF after = "LOCKED" THEN Disabled(a)
  ELSE IF after = "MOTION" THEN [DropMotion(a) EXCEPT !.press_travel_counts = 0]
  ELSE DropMotion(a)

-------------------------------------------------------------------------------
(* Phase 2. A repeated frame tells nothing only if a frame came before it. *)
IsValid(a, frame) == frame = "GOOD" \/ (frame = "REPEATED" /\ ~a.card_seen)

ObserveCard(c, a, frame) ==
  LET valid == IsValid(a, frame)
  IN  [a EXCEPT !.card_valid = valid,
                !.ticks_since_frame = IF a.card_valid THEN 1 ELSE CountUp(@, c.bad_frame_limit),
                !.bad_frames = IF valid THEN 0 ELSE CountUp(a.bad_frames, c.bad_frame_limit)]

-------------------------------------------------------------------------------
(* Phase 4: the new reading, the marks, and what is judged. *)
Follow(a, moved) ==
  LET delta == IF a.card_seen THEN moved ELSE 0
      Since(mark) == IF a.card_seen THEN mark + delta ELSE 0
  IN  [a EXCEPT !.card_seen = TRUE,
                !.ticks_since_frame = IF a.card_seen THEN a.ticks_since_frame ELSE 0,
                !.delta_counts = delta,
                !.position_counts = a.position_counts + delta,
                !.press_travel_counts = a.press_travel_counts + delta,
                !.since_stall_mark = Since(a.since_stall_mark),
                !.since_reverse_mark = Since(a.since_reverse_mark),
                !.since_drift_mark = Since(a.since_drift_mark),
                !.since_homing_mark = Since(a.since_homing_mark)]

ClearStallCount(a) ==
  [a EXCEPT !.stall_driven_ticks = 0, !.setpoint_changed = FALSE, !.since_stall_mark = 0]

(* The first frame after a drive tells what the drive did, however many were
   missed in between. *)
HasSettled(k, a) == ~WasDriven(a) /\ a.undriven_ticks >= k.settle_ticks

(* Motion is progress only until the axis has settled; later it is not the
   drive's doing. *)
MadeProgress(k, a) ==
  /\ ~HasSettled(k, a)
  /\ Along(a.stall_direction, a.since_stall_mark) > 0
  /\ Along(a.stall_direction, a.since_stall_mark) >= k.stall_min_counts

AdvanceReverseMark(a) ==
  IF Along(a.reverse_direction, a.since_reverse_mark) > 0
  THEN [a EXCEPT !.since_reverse_mark = 0] ELSE a

AdvanceStallMark(k, a) == IF MadeProgress(k, a) THEN ClearStallCount(a) ELSE a

AdvanceDriftMark(k, a) ==
  [a EXCEPT !.since_drift_mark = IF IsEnabled(a) /\ HasSettled(k, a) THEN @ ELSE 0]

Jumped(k, a)   == Magnitude(a.delta_counts) > k.max_delta_counts * a.ticks_since_frame
Reversed(k, a) == WasDriven(a) /\ -Along(a.reverse_direction, a.since_reverse_mark) > k.reverse_counts
Drifted(k, a)  == /\ IsEnabled(a)
                  /\ HasSettled(k, a)
                  /\ Magnitude(a.since_drift_mark) > k.drift_counts
Stalled(k, a)  == IsEnabled(a) /\ a.stall_driven_ticks >= k.stall_ticks

JudgeMotion(k, a) ==
  IF Jumped(k, a) THEN "JUMP"
  ELSE IF Reversed(k, a) THEN "REVERSE"
  ELSE IF Drifted(k, a) THEN "DRIFT"
  ELSE IF Stalled(k, a) THEN "STALL"
  ELSE "NONE"

-------------------------------------------------------------------------------
(* Phase 4: homing. *)
EnterPhase(a, phase) ==
  [a EXCEPT !.homing_phase = phase, !.since_homing_mark = 0, !.rest_ticks = 0]

TowardsSwitch(k)    == IF k.limit_side = "UPPER" THEN "INCREASING" ELSE "DECREASING"
AwayFromSwitch(k)   == IF k.limit_side = "UPPER" THEN "DECREASING" ELSE "INCREASING"

HomingDirection(k, a) ==
  CASE a.homing_phase = "BACK_OFF" -> AwayFromSwitch(k)
    [] a.homing_phase = "SEEK"     -> TowardsSwitch(k)
    [] OTHER                       -> "NONE"

WaitForRest(k, a) ==
  LET rest   == IF a.delta_counts = 0 THEN CountUp(a.rest_ticks, k.home_rest_ticks) ELSE 0
      waited == [a EXCEPT !.rest_ticks = rest]
  IN  IF rest >= k.home_rest_ticks
      THEN [EnterPhase(waited, "NONE") EXCEPT !.state = "ENABLED", !.homed = TRUE]
      ELSE waited

LookForEdge(k, a) ==
  CASE a.homing_phase = "BACK_OFF" -> IF a.switch_triggered THEN a ELSE EnterPhase(a, "SEEK")
    [] a.homing_phase = "SEEK"     ->
         IF a.switch_triggered
         THEN EnterPhase([a EXCEPT !.position_counts = k.home_offset_counts], "REST") ELSE a
    [] OTHER                       -> WaitForRest(k, a)

(* A switch that was not read makes no edge: only valid frames are looked at. *)
AdvanceHoming(k, a) ==
  IF a.state # "HOMING" THEN a
  ELSE LET counted == [a EXCEPT !.homing_ticks = CountDown(a.homing_ticks)]
       IN  IF a.card_valid THEN LookForEdge(k, counted) ELSE counted

HomingBound(k, a) ==
  IF a.homing_phase = "BACK_OFF" THEN k.home_backoff_counts ELSE k.home_travel_counts

JudgeHoming(k, a) ==
  IF a.state # "HOMING" THEN "NONE"
  ELSE IF Magnitude(a.since_homing_mark) > HomingBound(k, a) THEN "HOMING_TRAVEL"
  ELSE IF a.homing_ticks = 0 THEN "HOMING_TIMEOUT"
  ELSE "NONE"

-------------------------------------------------------------------------------
(* Phase 4, whole. *)
RunLeaseDown(a) ==
  LET left == CountDown(a.lease_ticks)
  IN  [a EXCEPT !.lease_ticks = left,
                !.state = IF a.state = "MOVING" /\ left = 0 THEN "ENABLED" ELSE a.state]

(* A drive needs a valid frame: an axis that was driven since its last one was
   driven in that very tick. *)
CountUndriven(k, a) ==
  LET driven_last_tick == WasDriven(a) /\ a.ticks_since_frame = 1
  IN  [a EXCEPT !.undriven_ticks = IF driven_last_tick THEN 0 ELSE CountUp(@, k.settle_ticks)]

(* A switch that was not read validly counts as triggered. *)
ReadSwitch(k, a, reading) == k.limit_side # "NONE" /\ (a.card_valid => reading.switch)

Awaited(k, a, reading) ==
  CountUndriven(k, RunLeaseDown([a EXCEPT !.switch_triggered = ReadSwitch(k, a, reading)]))

ObserveValid(k, a, reading) ==
  LET followed == AdvanceReverseMark(Follow(a, reading.moved))
      marked   == AdvanceDriftMark(k, AdvanceStallMark(k, followed))
  IN  [ axis  |-> [marked EXCEPT !.driven_direction = "NONE"],
        fault |-> JudgeMotion(k, marked) ]

ObserveMissing(c, a) ==
  IF CardIsLost(c, a)
  THEN [axis |-> [a EXCEPT !.card_seen = FALSE], fault |-> "CARD_LOST"]
  ELSE [axis |-> a, fault |-> "NONE"]

ObserveAxis(c, k, a, reading) ==
  LET awaited  == Awaited(k, a, reading)
      observed == IF a.card_valid THEN ObserveValid(k, awaited, reading)
                  ELSE ObserveMissing(c, awaited)
      advanced == AdvanceHoming(k, observed.axis)
      fault    == IF observed.fault # "NONE" THEN observed.fault ELSE JudgeHoming(k, advanced)
  IN  IF fault = "NONE" THEN advanced ELSE Faulted(advanced, fault)

-------------------------------------------------------------------------------
(* Phase 6: the row of the request table, from left to right. A request has kind,
   target (MOVE: setpoint, RESTORE: position), drive and lease. *)
PedalIsUp(s) == s.pedal = "RELEASED"

(* Neither driven nor moved since the last tick, which had a valid frame, too. *)
IsAtRest(a) == a.undriven_ticks > 0 /\ a.ticks_since_frame = 1 /\ a.delta_counts = 0

JudgeDisable(s, a) ==
  IF s.mode = "INIT" THEN "MODE"
  ELSE IF a.state = "FAULTED" THEN "FAULTED"
  ELSE "ACCEPTED"

JudgeEnable(s, a) ==
  IF s.mode \notin {"READY", "MOTION"} THEN "MODE"
  ELSE IF a.state = "FAULTED" THEN "FAULTED"
  ELSE IF ~a.card_valid THEN "CARD"
  ELSE "ACCEPTED"

JudgeClearFault(s, a) ==
  IF s.mode = "INIT" THEN "MODE"
  ELSE IF a.state # "FAULTED" THEN "NO_FAULT"
  ELSE IF ~a.card_valid \/ a.fault_now THEN "CAUSE_PRESENT"
  ELSE IF ~PedalIsUp(s) THEN "PEDAL_DOWN"
  ELSE "ACCEPTED"

JudgeMayMove(s, a) ==
  IF s.mode # "MOTION" THEN "MODE"
  ELSE IF a.state = "FAULTED" THEN "FAULTED"
  ELSE IF a.state = "DISABLED" THEN "DISABLED"
  ELSE IF a.state = "HOMING" THEN "BUSY"
  ELSE "ACCEPTED"

DriveBound(k, a) == IF a.homed THEN k.max_drive ELSE k.unhomed_max_drive

(* Where the axis may stop: one coast inside of its limits, or of the travel that
   an axis that is not homed has from where the pedal was pressed. *)
Reach(k, a) ==
  LET pressed_at == a.position_counts - a.press_travel_counts
      travel     == k.unhomed_travel_counts - k.coast_counts
  IN  IF a.homed THEN [low |-> k.min_counts + k.coast_counts, high |-> k.max_counts - k.coast_counts]
      ELSE [low |-> pressed_at - travel, high |-> pressed_at + travel]

JudgeMove(c, k, s, a, request) ==
  LET may == JudgeMayMove(s, a)
  IN  IF may # "ACCEPTED" THEN may
      ELSE IF request.lease = 0 \/ request.lease > c.lease_max_ticks THEN "LEASE"
      ELSE IF request.drive > DriveBound(k, a) THEN "DRIVE"
      ELSE IF request.target < Reach(k, a).low \/ request.target > Reach(k, a).high THEN "RANGE"
      ELSE "ACCEPTED"

JudgeHome(k, s, a) ==
  LET may == JudgeMayMove(s, a)
  IN  IF may = "ACCEPTED" /\ k.limit_side = "NONE" THEN "NO_SWITCH" ELSE may

JudgeDeclare(k, s, a, position) ==
  IF s.mode # "READY" THEN "MODE"
  ELSE IF ~PedalIsUp(s) THEN "PEDAL_DOWN"
  ELSE IF a.state = "FAULTED" THEN "FAULTED"
  ELSE IF ~a.card_valid THEN "CARD"
  ELSE IF ~IsAtRest(a) THEN "BUSY"
  ELSE IF position < k.min_counts \/ position > k.max_counts THEN "RANGE"
  ELSE "ACCEPTED"

JudgeAxis(c, k, s, a, request) ==
  CASE request.kind = "DISABLE"     -> JudgeDisable(s, a)
    [] request.kind = "ENABLE"      -> JudgeEnable(s, a)
    [] request.kind = "CLEAR_FAULT" -> JudgeClearFault(s, a)
    [] request.kind = "MOVE"        -> JudgeMove(c, k, s, a, request)
    [] request.kind = "HOME"        -> JudgeHome(k, s, a)
    [] request.kind = "SET_HOME"    -> JudgeDeclare(k, s, a, 0)
    [] request.kind = "RESTORE"     -> JudgeDeclare(k, s, a, request.target)

ClearFault(a) ==
  LET stalled == a.fault = "STALL"
  IN  [a EXCEPT !.state = "DISABLED", !.fault = "NONE", !.fault_now = FALSE,
                !.stall_driven_ticks = IF stalled THEN 0 ELSE @,
                !.setpoint_changed = @ /\ ~stalled]

Move(a, request) ==
  LET changed == a.setpoint_counts # request.target /\ a.stall_driven_ticks # 0
  IN  [a EXCEPT !.state = "MOVING", !.setpoint_counts = request.target,
                !.drive = request.drive, !.lease_ticks = request.lease,
                !.setpoint_changed = @ \/ changed]

BeginHoming(k, a) ==
  EnterPhase([a EXCEPT !.state = "HOMING", !.homed = FALSE, !.lease_ticks = 0,
                       !.homing_ticks = k.home_timeout_ticks],
             IF a.switch_triggered THEN "BACK_OFF" ELSE "SEEK")

ApplyAxis(k, a, request) ==
  CASE request.kind = "DISABLE"     -> Disabled(a)
    [] request.kind = "ENABLE"      -> IF a.state = "DISABLED" THEN [a EXCEPT !.state = "ENABLED"] ELSE a
    [] request.kind = "CLEAR_FAULT" -> ClearFault(a)
    [] request.kind = "MOVE"        -> Move(a, request)
    [] request.kind = "HOME"        -> BeginHoming(k, a)
    [] request.kind = "SET_HOME"    -> [a EXCEPT !.position_counts = 0, !.homed = TRUE]
    [] request.kind = "RESTORE"     -> [a EXCEPT !.position_counts = request.target, !.homed = FALSE]

-------------------------------------------------------------------------------
(* Phase 7: what the axis wants. *)
TowardsSetpoint(k, a) ==
  LET distance == a.setpoint_counts - a.position_counts
  IN  IF distance > k.deadband_counts THEN "INCREASING"
      ELSE IF distance < -k.deadband_counts THEN "DECREASING"
      ELSE "NONE"

WantedCommand(k, a) ==
  CASE a.state = "MOVING" -> [direction |-> TowardsSetpoint(k, a), drive |-> a.drive]
    [] a.state = "HOMING" -> [direction |-> HomingDirection(k, a), drive |-> k.home_drive]
    [] OTHER              -> NoDrive

(* The output gate: the first condition that blocks, "OPEN" if none does. *)
IsHeld(a) == (a.state = "MOVING" /\ a.lease_ticks # 0) \/ a.state = "HOMING"

PressesOnSwitch(k, a, direction) ==
  a.switch_triggered /\ k.limit_side # "NONE" /\ direction = TowardsSwitch(k)

LeavesSoftRange(k, a, direction) ==
  /\ a.homed
  /\ \/ direction = "INCREASING" /\ a.position_counts >= k.max_counts - k.coast_counts
     \/ direction = "DECREASING" /\ a.position_counts <= k.min_counts + k.coast_counts

ExceedsUnhomedTravel(k, a, direction) ==
  /\ ~a.homed
  /\ a.state # "HOMING"
  /\ Along(direction, a.press_travel_counts) >= k.unhomed_travel_counts - k.coast_counts

Gate(k, s, a, wanted) ==
  IF s.mode # "MOTION" THEN "MODE"
  ELSE IF s.pedal # "PRESSED" THEN "PEDAL"
  ELSE IF s.estop THEN "ESTOP"
  ELSE IF ~a.card_valid THEN "CARD"
  ELSE IF ~IsEnabled(a) THEN "ENABLE"
  ELSE IF ~IsHeld(a) THEN "LEASE"
  ELSE IF wanted.direction = "NONE" \/ wanted.drive = 0 THEN "SETPOINT"
  ELSE IF PressesOnSwitch(k, a, wanted.direction) THEN "HARD_LIMIT"
  ELSE IF LeavesSoftRange(k, a, wanted.direction) THEN "SOFT_LIMIT"
  ELSE IF ExceedsUnhomedTravel(k, a, wanted.direction) THEN "UNHOMED_TRAVEL"
  ELSE IF wanted.drive > DriveBound(k, a) THEN "DRIVE"
  ELSE "OPEN"

(* What the kernel keeps of having driven an axis: a new direction, or one taken
   up again after the axis had settled, begins its marks anew. *)
NoteDrive(k, a, direction) ==
  LET rested == a.undriven_ticks >= k.settle_ticks
      turned == rested \/ a.reverse_direction # direction
      anew   == rested \/ a.stall_direction # direction
  IN  [a EXCEPT !.reverse_direction = direction,
                !.since_reverse_mark = IF turned THEN 0 ELSE @,
                !.stall_direction = direction,
                !.since_stall_mark = IF anew THEN 0 ELSE @,
                !.stall_driven_ticks = CountUp(@, k.stall_ticks),
                !.driven_direction = direction]

(* In the deadband of its setpoint; it cleared the stall count if the setpoint did
   not change while the axis was driven. *)
NoteArrival(a) == IF a.setpoint_changed THEN a ELSE ClearStallCount(a)

(* Phase 7 of one axis: its record, its command and what its gate says. *)
DriveAxis(k, s, a) ==
  LET wanted  == WantedCommand(k, a)
      gate    == Gate(k, s, a, wanted)
      arrived == gate = "SETPOINT" /\ a.state = "MOVING" /\ wanted.direction = "NONE"
  IN  [ axis    |-> IF gate = "OPEN" THEN NoteDrive(k, a, wanted.direction)
                    ELSE IF arrived THEN NoteArrival(a) ELSE a,
        gate    |-> gate,
        command |-> IF gate = "OPEN" THEN wanted ELSE NoDrive ]
===============================================================================
