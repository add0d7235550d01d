-------------------------------- MODULE System --------------------------------
(* The system's part of a tick: modes, pedal, E-stop, app, bus, deadlines and the
   requests HEARTBEAT, STOP and RESET. Operators only: each takes the
   configuration `c` and the system's record `s` and gives the record after it.

   Fields of `s` are those of ilk_state_t. Not modelled: tick, cause_tick,
   cause_value, sequence numbers and totals since boot, which no decision reads
   (a request's `door` stands for its number). Counts stop at the value from
   which on they decide nothing more; the kernel counts on to 2^32 - 1.

   `c` has pedal_channels, app_timeout_ticks, lease_max_ticks, power_up_ticks,
   pedal_debounce_ticks, pedal_disagree_ticks, bad_frame_limit, overrun_limit.

   `in` has new_attachment, pedal_no, pedal_nc, estop_loop (Contacts), missed (loop
   periods without a tick since the last one), any_valid (a frame of any card was
   valid), consent (the number that an entry to MOTION gets in this tick; the
   environment gives each entry another one), and config_pass: what the running check
   of the configuration says in this tick, "NONE" (the pass is under way), "AGREES",
   "DIFFERS" or "INVALID" (it agrees with a configuration that ilk_config_validate
   refuses). *)
EXTENDS Types

SystemType(c, holders) ==
  [ mode: Modes, cause: Causes, causes_seen: SUBSET (Causes \ {"NONE"}),
    pedal: PedalStates, pedal_armed: BOOLEAN,
    pedal_pressed_ticks: 0..c.pedal_debounce_ticks,
    pedal_released_ticks: 0..c.pedal_debounce_ticks,
    pedal_disagree_ticks: 0..(c.pedal_disagree_ticks + 1),
    estop: BOOLEAN,
    app_age_ticks: 0..c.app_timeout_ticks, app_alive: BOOLEAN, holder: holders,
    overruns_in_row: 0..c.overrun_limit, bus_bad_ticks: 0..c.bad_frame_limit,
    power_ticks: 0..c.power_up_ticks, consent: Nat, runaway: BOOLEAN,
    config_sound: BOOLEAN ]

(* The contactor, or the supply of the amplifiers. *)
Power(s) == s.mode \in {"READY", "MOTION"}

(* What holds between the fields at the end of every tick. It is inductive: a tick
   keeps it whatever comes in. *)
SystemInvariant(c, s) ==
  /\ (s.mode = "LOCKED") = (s.cause # "NONE")
  /\ s.mode # "LOCKED" => s.causes_seen = {}
  /\ s.mode # "READY" => ~s.pedal_armed /\ s.pedal_released_ticks = 0
  /\ s.pedal_armed => s.app_alive
  /\ s.pedal_pressed_ticks > 0 => s.pedal_armed /\ s.pedal = "PRESSED"
  /\ s.pedal_released_ticks > 0 => s.app_alive /\ s.pedal = "RELEASED"
  /\ s.pedal_disagree_ticks > 0 => s.pedal = "DISAGREE"
  /\ s.app_alive => s.app_age_ticks < c.app_timeout_ticks
  /\ (s.mode = "MOTION") = (s.consent # 0)
  /\ ~Power(s) => s.power_ticks = 0
  /\ Power(s) =>
       /\ ~s.estop
       /\ ~s.runaway
       /\ s.config_sound
       /\ s.bus_bad_ticks < c.bad_frame_limit
       /\ s.overruns_in_row < c.overrun_limit
       /\ s.pedal_disagree_ticks <= c.pedal_disagree_ticks
  /\ s.mode = "MOTION" =>
       s.pedal = "PRESSED" /\ s.app_alive /\ s.power_ticks = c.power_up_ticks

(* After ilk_init, or when a damaged state was rebuilt: nothing is known, so all
   is taken to be at its worst. *)
Rebuilt(c, cause, holder) ==
  [ mode |-> "LOCKED", cause |-> cause, causes_seen |-> {cause},
    pedal |-> "DISAGREE", pedal_armed |-> FALSE,
    pedal_pressed_ticks |-> 0, pedal_released_ticks |-> 0,
    pedal_disagree_ticks |-> 0, estop |-> TRUE,
    app_age_ticks |-> c.app_timeout_ticks, app_alive |-> FALSE,
    holder |-> holder, overruns_in_row |-> 0, bus_bad_ticks |-> 0,
    power_ticks |-> 0, consent |-> 0, runaway |-> FALSE,
    config_sound |-> FALSE ]

Booted(c, valid, holder) ==
  IF valid
  THEN [Rebuilt(c, "BOOT", holder) EXCEPT !.config_sound = TRUE]
  ELSE [Rebuilt(c, "NONE", holder) EXCEPT !.mode = "INIT", !.causes_seen = {}]

-------------------------------------------------------------------------------
(* Phase 1, the part that concerns the configuration. A configuration that is
   not trusted becomes so by a whole pass that agrees and by being valid. *)
CheckConfiguration(s, in) ==
  CASE in.config_pass = "DIFFERS" -> [s EXCEPT !.config_sound = FALSE]
    [] in.config_pass = "AGREES"  -> [s EXCEPT !.config_sound = TRUE]
    [] OTHER                      -> s

(* Phase 2, for the system: does the bus say anything at all? *)
ObserveBus(c, s, in) ==
  [s EXCEPT !.bus_bad_ticks =
     IF in.any_valid THEN 0 ELSE CountUp(s.bus_bad_ticks, c.bad_frame_limit)]

-------------------------------------------------------------------------------
(* Phase 3. *)
ObserveApp(c, s, in) ==
  LET before == IF in.new_attachment THEN c.app_timeout_ticks ELSE s.app_age_ticks
      age    == CountUp(before, c.app_timeout_ticks)
  IN  [s EXCEPT !.app_age_ticks = age,
                !.app_alive = (age < c.app_timeout_ticks)]

(* Pressed: every channel says so. Released: every channel says so. Anything
   else, an invalid contact included, is a disagreement. *)
ReadPedal(c, in) ==
  LET second == c.pedal_channels = 2
  IN  IF in.pedal_no = "CLOSED" /\ (second => in.pedal_nc = "OPEN") THEN "PRESSED"
      ELSE IF in.pedal_no = "OPEN" /\ (second => in.pedal_nc = "CLOSED") THEN "RELEASED"
      ELSE "DISAGREE"

(* A release counts only in READY with the app alive, a press only when armed. *)
ObservePedal(c, s, in) ==
  LET pedal == ReadPedal(c, in)
  IN  [s EXCEPT
        !.pedal = pedal,
        !.pedal_disagree_ticks =
          IF pedal = "DISAGREE"
          THEN CountUp(s.pedal_disagree_ticks, c.pedal_disagree_ticks + 1) ELSE 0,
        !.pedal_released_ticks =
          IF pedal = "RELEASED" /\ s.mode = "READY" /\ s.app_alive
          THEN CountUp(s.pedal_released_ticks, c.pedal_debounce_ticks) ELSE 0,
        !.pedal_pressed_ticks =
          IF pedal = "PRESSED" /\ s.pedal_armed
          THEN CountUp(s.pedal_pressed_ticks, c.pedal_debounce_ticks) ELSE 0]

ObserveDeadline(c, s, in) ==
  [s EXCEPT !.overruns_in_row =
     IF in.missed > 0 THEN CountBy(s.overruns_in_row, in.missed, c.overrun_limit) ELSE 0]

ObservePower(c, s) ==
  [s EXCEPT !.power_ticks = IF Power(s) THEN CountUp(@, c.power_up_ticks) ELSE 0]

ObserveEstop(s, in) == [s EXCEPT !.estop = (in.estop_loop # "CLOSED")]

ObserveSystem(c, s, in) ==
  LET app      == ObserveApp(c, s, in)
      pedal    == ObservePedal(c, app, in)
      deadline == ObserveDeadline(c, pedal, in)
  IN  ObserveEstop(ObservePower(c, deadline), in)

-------------------------------------------------------------------------------
(* Phase 5. What a change of mode does to an axis is FollowMode in Axis. `alarms` is
   what the axes say: new_fault, required_card_lost, runaway (one that is FAULTED
   moves), restless (one that is DISABLED has just been moved); and whether the
   configuration was found damaged. *)
Disarmed(s) == [s EXCEPT !.pedal_armed = FALSE, !.pedal_pressed_ticks = 0,
                         !.pedal_released_ticks = 0]

Enter(s, mode) == [Disarmed(s) EXCEPT !.mode = mode, !.consent = 0,
                                      !.power_ticks = IF mode = "LOCKED" THEN 0 ELSE @]

(* Every cause that holds in this tick, the one that is kept first in front. *)
CausesNow(c, s, alarms) ==
     (IF alarms.configuration_damaged                      THEN <<"INTEGRITY">> ELSE <<>>)
  \o (IF s.estop                                           THEN <<"ESTOP">>     ELSE <<>>)
  \o (IF s.bus_bad_ticks >= c.bad_frame_limit              THEN <<"BUS">>       ELSE <<>>)
  \o (IF s.pedal_disagree_ticks > c.pedal_disagree_ticks   THEN <<"PEDAL">>     ELSE <<>>)
  \o (IF s.overruns_in_row >= c.overrun_limit              THEN <<"OVERRUN">>   ELSE <<>>)
  \o (IF alarms.runaway                                    THEN <<"RUNAWAY">>   ELSE <<>>)

Lock(s, causes) ==
  LET locked == IF s.mode = "LOCKED" THEN s
                ELSE [Enter(s, "LOCKED") EXCEPT !.cause = Head(causes)]
  IN  [locked EXCEPT !.causes_seen =
         s.causes_seen \union {causes[i] : i \in 1..Len(causes)}]

MotionMustEnd(s, alarms) ==
  \/ s.pedal # "PRESSED"
  \/ ~s.app_alive
  \/ alarms.new_fault
  \/ alarms.required_card_lost

(* The app falls silent: what was seen of the pedal counts no more. *)
Armed(c, s) ==
  IF ~s.app_alive THEN Disarmed(s)
  ELSE IF s.pedal_released_ticks >= c.pedal_debounce_ticks
       THEN [s EXCEPT !.pedal_armed = TRUE]
       ELSE s

PressCompletes(c, s) == s.pedal_armed /\ s.pedal_pressed_ticks >= c.pedal_debounce_ticks

MotionMayBegin(c, s, alarms) ==
  /\ s.power_ticks >= c.power_up_ticks
  /\ s.app_alive
  /\ ~alarms.required_card_lost
  /\ ~alarms.restless

(* A press that completes begins MOTION, or else the next try needs a release. *)
WaitForPress(c, s, alarms, consent) ==
  IF ~PressCompletes(c, s) THEN s
  ELSE IF MotionMayBegin(c, s, alarms)
       THEN [Enter(s, "MOTION") EXCEPT !.consent = consent]
       ELSE Disarmed(s)

ChangeMode(c, system, alarms, consent) ==
  LET s      == [system EXCEPT !.runaway = alarms.runaway]
      causes == CausesNow(c, s, alarms)
  IN  IF causes # <<>> THEN Lock(s, causes)
      ELSE IF s.mode = "MOTION"
           THEN IF MotionMustEnd(s, alarms) THEN Enter(s, "READY") ELSE s
      ELSE IF s.mode = "READY" THEN WaitForPress(c, Armed(c, s), alarms, consent)
      ELSE s

-------------------------------------------------------------------------------
(* Phase 6, for the requests that name no axis. A request has door, kind and
   holder (HEARTBEAT). *)
CausePresent(s) ==
  \/ s.estop
  \/ s.bus_bad_ticks # 0
  \/ s.overruns_in_row # 0
  \/ ~s.config_sound
  \/ s.runaway
  \/ ~s.app_alive

JudgeDoor(request, axes) ==
  IF request.door # "INTACT" THEN request.door
  ELSE IF request.kind \notin Kinds THEN "UNKNOWN"
  ELSE IF request.kind \in AxisKinds /\ request.axis \notin axes THEN "AXIS"
  ELSE "ACCEPTED"

JudgeReset(s) ==
  IF s.mode # "LOCKED" THEN "MODE"
  ELSE IF s.pedal # "RELEASED" THEN "PEDAL_DOWN"
  ELSE IF CausePresent(s) THEN "CAUSE_PRESENT"
  ELSE "ACCEPTED"

JudgeSystem(s, request) ==
  IF request.kind = "RESET" THEN JudgeReset(s)
  ELSE IF s.mode = "INIT" THEN "MODE"
  ELSE "ACCEPTED"

Heard(s, holder) ==
  LET heard == [s EXCEPT !.app_age_ticks = 0, !.holder = holder]
  IN  IF s.holder = holder THEN heard
      ELSE IF s.mode = "MOTION" THEN Enter(heard, "READY")
      ELSE Disarmed(heard)

ApplySystem(s, request) ==
  CASE request.kind = "HEARTBEAT" -> Heard(s, request.holder)
    [] request.kind = "STOP"      -> IF s.mode = "MOTION" THEN Enter(s, "READY") ELSE Disarmed(s)
    [] request.kind = "RESET"     ->
         [Enter(s, "READY") EXCEPT !.cause = "NONE", !.causes_seen = {}]
===============================================================================
