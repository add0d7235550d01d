------------------------------- MODULE KernelOne ------------------------------
(* One axis in full, the system, and a plant that does as it likes: it moves, sticks,
   slips, coasts, is pushed by hand, jumps. One step is one tick.

   The axis may move in an ordinary tick, with a MOVE and when its frame is missing;
   of the things that depart from an ordinary tick there is at most one at a time. *)
EXTENDS Kernel, Meets

CONSTANTS c,        \* the system's configuration, see SmallSystem
          k,        \* the axis' configuration, see SmallAxis
          Watched,  \* TRUE: keep `seen` and `io`, which the properties of a tick are about
          Lawful,   \* TRUE: driven, the plant goes that way or sticks; undriven, it
                    \* coasts no farther than coast_counts
          body      \* the mechanical range of the axis, low to high; at or below
                    \* switch_at its switch is triggered

SmallSystem ==
  [ pedal_channels |-> 1, app_timeout_ticks |-> 2, lease_max_ticks |-> 2,
    pedal_debounce_ticks |-> 1, pedal_disagree_ticks |-> 1,
    bad_frame_limit |-> 2, overrun_limit |-> 1 ]

SmallAxis ==
  [ limit_side |-> "LOWER", min_counts |-> -2, max_counts |-> 2,
    home_offset_counts |-> -2, coast_counts |-> 1, deadband_counts |-> 0,
    max_drive |-> 2, unhomed_max_drive |-> 1, unhomed_travel_counts |-> 2,
    home_drive |-> 1, home_travel_counts |-> 3, home_backoff_counts |-> 1,
    home_timeout_ticks |-> 4, home_rest_ticks |-> 1, stall_ticks |-> 2,
    stall_min_counts |-> 1, reverse_counts |-> 1, drift_counts |-> 1,
    settle_ticks |-> 1, max_delta_counts |-> 1, required |-> TRUE ]

(* Rest takes longer to tell: every count of ticks without drive is a state of its own. *)
SettlingAxis == [SmallAxis EXCEPT !.settle_ticks = 2]

(* For a lawful plant: it has room to coast. *)
CoastingAxis ==
  [SmallAxis EXCEPT !.max_counts = 3, !.coast_counts = 2, !.max_drive = 1,
     !.unhomed_travel_counts = 3, !.home_travel_counts = 6, !.home_timeout_ticks = 7,
     !.reverse_counts = 2, !.drift_counts = 2, !.settle_ticks = 2]

CoastingBody == [low |-> -2, high |-> 4, switch_at |-> -2]

SmallBody == [low |-> -2, high |-> 1, switch_at |-> -2]

X == 0         \* the axis' slot
K == (X :> k)

VARIABLES
  system, axis,  \* the kernel's records
  plant,         \* where the axis is, and what its card has not yet told
  seen,          \* of the properties: what a witness of inputs and outputs has counted
  io             \* the last tick

vars == <<system, axis, plant, seen, io>>

(* Two states that differ in io alone are one; properties of a tick are checked on
   every step, repeated ones included. *)
View == <<system, axis, plant, seen>>

(* What no later tick looks at is set to one value, so that states that will
   behave alike are one: each of these is written anew before it is read. Two are
   choices of the model: an axis that is faulted and not homed, or whose card is
   lost, takes up its position again at the raw counter, and the travel since the
   pedal was pressed, which bounds an axis that is not homed, is counted from where
   the axis was last homed, if it was. *)
Forget(s, a, raw) ==
  LET settled == a.undriven_ticks >= k.settle_ticks /\ ~WasDriven(a)
      astray  == ~a.card_seen \/ (a.state = "FAULTED" /\ ~a.homed)
  IN  [a EXCEPT !.delta_counts = 0, !.card_valid = FALSE, !.switch_triggered = FALSE,
                !.ticks_since_frame = IF a.card_valid THEN 0 ELSE @,
                !.since_homing_mark = IF a.homing_phase = "NONE" THEN 0 ELSE @,
                !.homing_ticks = IF a.homing_phase = "NONE" THEN 0 ELSE @,
                !.rest_ticks = IF a.homing_phase = "REST" THEN @ ELSE 0,
                !.press_travel_counts = IF s.mode = "MOTION" /\ ~a.homed THEN @ ELSE 0,
                !.position_counts = IF astray THEN raw ELSE @,
                !.since_stall_mark = IF settled THEN 0 ELSE @,
                !.stall_direction = IF settled THEN "NONE" ELSE @,
                !.since_reverse_mark = IF settled THEN 0 ELSE @,
                !.reverse_direction = IF settled THEN "NONE" ELSE @]

ForgetSystem(s) == [s EXCEPT !.causes_seen = {}, !.app_alive = FALSE, !.estop = FALSE,
                             !.pedal = "DISAGREE"]

-------------------------------------------------------------------------------
(* The plant: `at` in raw counts, `untold` since the last valid frame, and if it is
   lawful how it is driven, how far it may still coast, and in which sense. *)
AtRest == [at |-> 0, untold |-> 0, driven |-> "NONE", coast |-> 0, sense |-> "NONE"]

Sense(direction) == Along(direction, 1)

LawfulMoves ==
  IF plant.driven # "NONE" THEN {0, Sense(plant.driven)}
  ELSE IF plant.coast > 0 THEN {0, Sense(plant.sense)} ELSE {0}

Moves == {m \in (IF Lawful THEN LawfulMoves ELSE {-1, 0, 1}) : plant.at + m \in body.low..body.high}

Jumps == IF Lawful THEN {} ELSE {m \in {-2, 2} : plant.at + m \in body.low..body.high}

Moved(m, told, command) ==
  LET left  == (IF plant.driven # "NONE" THEN k.coast_counts ELSE plant.coast) - Magnitude(m)
      coasts == Lawful /\ m # 0 /\ left > 0
  IN  [ at     |-> plant.at + m,
        untold |-> IF told THEN 0 ELSE plant.untold + m,
        driven |-> IF Lawful THEN command.direction ELSE "NONE",
        coast  |-> IF coasts THEN left ELSE 0,
        sense  |-> IF ~coasts THEN "NONE" ELSE IF m > 0 THEN "INCREASING" ELSE "DECREASING" ]

Reading(m, frame) ==
  [frame |-> frame, moved |-> plant.untold + m, switch |-> plant.at + m <= body.switch_at]

-------------------------------------------------------------------------------
(* Inputs and requests *)
Wish(kind) == [kind |-> kind, door |-> "INTACT", axis |-> X, holder |-> 1,
               target |-> 0, drive |-> 0, lease |-> 0]

MoveTo(target, drive, lease) ==
  [Wish("MOVE") EXCEPT !.target = target, !.drive = drive, !.lease = lease]

Alive == <<Wish("HEARTBEAT")>>

(* What an app asks for where it may be granted. It declares a position that is
   true, or one count off. *)
Wishes ==
  CASE system.mode = "LOCKED" -> {Wish("RESET"), Wish("CLEAR_FAULT")}
    [] system.mode = "READY" ->
         {Wish("ENABLE"), Wish("DISABLE"), Wish("CLEAR_FAULT")}
         \union (IF plant.at \in {0, 1} THEN {Wish("SET_HOME")} ELSE {})
         \union {[Wish("RESTORE") EXCEPT !.target = at] : at \in {plant.at, plant.at - 1}}
    [] OTHER -> {Wish("STOP"), Wish("DISABLE"), Wish("ENABLE"), Wish("HOME")}

MovingWishes == {MoveTo(1, 2, 2), MoveTo(1, 1, 2), MoveTo(-1, 1, 1)}

(* Refused, but for the first where an axis that is not homed reaches it. *)
Unwelcome == <<MoveTo(k.max_counts, 1, 2), MoveTo(0, k.max_drive + 1, 2),
               MoveTo(0, 1, c.lease_max_ticks + 1)>>

Input(pedal, estop, reading, requests) ==
  [ pedal_no |-> pedal, pedal_nc |-> "OPEN", estop_loop |-> estop, deadline_missed |-> FALSE,
    new_attachment |-> FALSE, config_pass |-> "NONE", any_valid |-> FALSE,
    readings |-> (X :> reading), requests |-> requests, state_damaged |-> FALSE ]

(* As a person would hold it: pressed in MOTION and, once armed, to get there. *)
Held    == IF system.mode = "MOTION" \/ system.pedal_armed THEN "CLOSED" ELSE "OPEN"
NotHeld == IF Held = "CLOSED" THEN "OPEN" ELSE "CLOSED"

-------------------------------------------------------------------------------
(* A tick *)

(* What a witness keeps who sees the raw counter and the commands, but none of the
   kernel's marks and counts: for how many ticks the axis was driven without progress,
   the reading from which that counts, whether its setpoint changed meanwhile, which
   way it was driven, the farthest reading on that way, the last reading at which it
   was not yet at rest, the reading where the pedal was pressed, whether it was homing
   since, whether anything was asked for since, and for how many ticks it was not driven. *)
Nothing == [driven |-> 0, from |-> 0, changed |-> FALSE, way |-> "NONE", far |-> 0, rest_at |-> 0,
            pressed_at |-> 0, homing |-> FALSE, asked |-> FALSE,
            quiet |-> k.settle_ticks]

(* The search begins at power-on, and as well where MOTION has just begun with the
   axis enabled: that shortens refutations. A search from power-on alone finds the
   same states. *)
RECURSIVE After(_, _)
After(kernel, inputs) ==
  IF inputs = <<>> THEN kernel
  ELSE LET tick == Tick(c, K, kernel, Head(inputs))
       IN  After([system |-> ForgetSystem(tick.system),
                  axes |-> (X :> Forget(tick.system, tick.axes[X], 0))], Tail(inputs))

Still(pedal, requests) == Input(pedal, "CLOSED", Reading(0, "GOOD"), requests)

IntoMotion == <<Still("OPEN", Alive), Still("OPEN", Append(Alive, Wish("RESET"))),
                Still("OPEN", Append(Alive, Wish("ENABLE"))), Still("CLOSED", Alive)>>

Kernels ==
  LET off == [system |-> Booted(c, TRUE, 1), axes |-> (X :> BlankAxis)]
  IN  {off, After(off, IntoMotion)}

Init ==
  /\ plant = AtRest
  /\ \E kernel \in Kernels : system = kernel.system /\ axis = kernel.axes[X]
  /\ seen = Nothing
  /\ io = [command |-> NoDrive]

Kernel0 == [system |-> system, axes |-> (X :> axis)]

Told == plant.at - plant.untold
Now(in, a) == IF a.card_valid THEN Told + in.readings[X].moved ELSE Told

Accepted(tick, kinds) ==
  \E i \in 1..Len(tick.answers) :
    tick.answers[i].request.kind \in kinds /\ tick.answers[i].verdict = "ACCEPTED"

(* Undriven for long enough; and if a frame has told of the last drive, what it
   moves now is not the drive's doing. *)
HasRested == seen.quiet >= k.settle_ticks
IsSettled == HasRested /\ ~WasDriven(axis)

(* Net progress on the way that it was driven, and not after it had settled. *)
Progressed(in, a) == /\ a.card_valid /\ axis.card_seen /\ ~IsSettled
                     /\ Along(seen.way, Now(in, a) - seen.from) >= k.stall_min_counts

Arrived(s, a) ==
  s.mode = "MOTION" /\ a.state = "MOVING" /\ a.card_valid /\ s.pedal = "PRESSED" /\ ~s.estop
  /\ Magnitude(a.setpoint_counts - a.position_counts) <= k.deadband_counts

BeginsAnew(in, tick, a) ==
  Progressed(in, a) \/ (Arrived(tick.system, a) /\ ~seen.changed)

Excused(in, tick, a) ==
  BeginsAnew(in, tick, a) \/ (Accepted(tick, {"CLEAR_FAULT"}) /\ axis.fault = "STALL")

Witnessed(in, tick) ==
  LET a        == tick.axes[X]
      command  == tick.command[X]
      now      == Now(in, a)
      settled  == IsSettled
      count    == IF Excused(in, tick, a) THEN 0 ELSE seen.driven
      moving   == tick.system.mode = "MOTION"
      entered  == moving /\ system.mode # "MOTION"
      farther  == Along(seen.way, now - seen.far) > 0
      anew     == command.drive # 0 /\ (HasRested \/ command.direction # seen.way)
  IN  [ driven     |-> IF command.drive # 0 THEN CountUp(count, k.stall_ticks + 1) ELSE count,
        from       |-> IF anew \/ settled \/ BeginsAnew(in, tick, a) THEN now ELSE seen.from,
        changed    |-> count # 0 /\ (seen.changed \/ a.setpoint_counts # axis.setpoint_counts),
        way        |-> IF command.drive # 0 THEN command.direction
                       ELSE IF settled THEN "NONE" ELSE seen.way,
        far        |-> IF anew \/ farther \/ (settled /\ command.drive = 0)
                       THEN now ELSE seen.far,
        rest_at    |-> IF a.card_valid /\ ~(settled /\ IsEnabled(tick.observed.axes[X]))
                       THEN now ELSE seen.rest_at,
        pressed_at |-> IF entered \/ ~moving \/ a.homed THEN now ELSE seen.pressed_at,
        homing     |-> moving /\ (seen.homing \/ a.state = "HOMING"),
        asked      |-> moving /\ (seen.asked \/ Accepted(tick, {"MOVE", "HOME"})),
        quiet      |-> IF command.drive # 0 THEN 0 ELSE CountUp(seen.quiet, k.settle_ticks) ]

(* What io keeps of an answer. *)
Outcome(answer) == [request |-> answer.request, verdict |-> answer.verdict,
                    inert |-> answer.after = answer.before]

(* The tick is bound as the element of a set, which evaluates it once. *)
Step(in) ==
  \E tick \in {Tick(c, K, Kernel0, in)} :
    /\ system' = ForgetSystem(tick.system)
    /\ plant' = Moved(in.readings[X].moved - plant.untold,
                      tick.axes[X].card_valid \/ ~tick.axes[X].card_seen, tick.command[X])
    /\ axis' = Forget(tick.system, tick.axes[X], plant'.at - plant'.untold)
    /\ seen' = IF Watched THEN Witnessed(in, tick) ELSE seen
    /\ io' = IF ~Watched THEN io ELSE
             [in |-> in, command |-> tick.command[X], gate |-> tick.gate[X],
              answers |-> [i \in 1..Len(tick.answers) |-> Outcome(tick.answers[i])],
              system |-> tick.system, axis |-> tick.axes[X], observed |-> tick.observed.axes[X]]

OrdinaryTick == Met("OrdinaryTick") /\ \E m \in Moves :
  Step(Input(Held, "CLOSED", Reading(m, "GOOD"), Alive))

MoveTick == system.mode = "MOTION" /\ Met("MoveTick") /\ \E wish \in MovingWishes, m \in Moves :
  Step(Input(Held, "CLOSED", Reading(m, "GOOD"), Append(Alive, wish)))

BadFrameTick == Met("BadFrameTick") /\ \E m \in Moves :
  Step(Input(Held, "CLOSED", Reading(m, "MISSING"), Alive))

JumpTick == \E m \in Jumps :
  Met("JumpTick") /\ Step(Input(Held, "CLOSED", Reading(m, "GOOD"), Alive))

RequestTick == Met("RequestTick") /\ \E wish \in Wishes : Step(Still(Held, Append(Alive, wish)))
RefusedTick == system.mode # "LOCKED" /\ Met("RefusedTick") /\ Step(Still(Held, Alive \o Unwelcome))
PedalTick   == Met("PedalTick") /\ Step(Still(NotHeld, Alive))
SilentTick  == Met("SilentTick") /\ Step(Still(Held, <<>>))
EstopTick   == Met("EstopTick") /\ Step(Input(Held, "OPEN", Reading(0, "GOOD"), Alive))

Next ==
  \/ OrdinaryTick \/ MoveTick \/ BadFrameTick \/ JumpTick \/ RequestTick \/ RefusedTick
  \/ PedalTick \/ SilentTick \/ EstopTick

Spec == Init /\ [][Next]_vars

-------------------------------------------------------------------------------
(* Properties, as in kernel.md. The primed io is this very tick: `in` what came in,
   `system` and `axis` the records at its end, `observed` the axis' record before
   any request was answered. *)
Driven  == io'.command.drive # 0
Input1  == io'.in.readings[X]

P1_gate ==
  [][ Driven =>
        /\ io'.system.mode = "MOTION"
        /\ ReadPedal(c, io'.in) = "PRESSED"
        /\ io'.in.estop_loop = "CLOSED"
        /\ Input1.frame = "GOOD"
        /\ io'.axis.state \in {"ENABLED", "MOVING", "HOMING"}
        /\ io'.axis.lease_ticks > 0 \/ io'.axis.state = "HOMING" ]_vars

P2_stop ==
  [][ (\/ ReadPedal(c, io'.in) # "PRESSED"
       \/ io'.in.estop_loop # "CLOSED"
       \/ io'.system.mode \in {"LOCKED", "READY"}
       \/ io'.system.bus_bad_ticks >= c.bad_frame_limit
       \/ ~io'.system.app_alive)
      => ~Driven ]_vars

P3_hard_limit ==
  [][ (Input1.switch \/ Input1.frame # "GOOD") /\ Driven
      => io'.command.direction # TowardsSwitch(k) ]_vars

P4_soft_limit ==
  [][ Driven /\ io'.axis.homed =>
        /\ io'.command.direction = "INCREASING"
           => io'.axis.position_counts < k.max_counts - k.coast_counts
        /\ io'.command.direction = "DECREASING"
           => io'.axis.position_counts > k.min_counts + k.coast_counts ]_vars

(* Only of a lawful plant. *)
InRange(a) == a.position_counts \in k.min_counts..k.max_counts

P4_soft_range ==
  [][ axis.homed /\ io'.axis.homed /\ InRange(axis) => InRange(io'.axis) ]_vars

P5_stall ==
  [][ /\ seen'.driven <= k.stall_ticks
      /\ seen.driven >= k.stall_ticks /\ IsEnabled(axis) /\ Input1.frame = "GOOD"
         /\ ~Progressed(io'.in, io'.observed)
         => io'.observed.state = "FAULTED" ]_vars

Beyond(travel, bound) == Magnitude(travel) > bound

P6_jump ==
  [][ Input1.frame = "GOOD" /\ axis.card_seen
      /\ Beyond(Input1.moved, k.max_delta_counts * (axis.ticks_since_frame + 1))
      => io'.observed.state = "FAULTED" ]_vars

P6_reverse ==
  [][ Input1.frame = "GOOD" /\ axis.card_seen /\ WasDriven(axis)
      /\ Along(axis.driven_direction, Now(io'.in, io'.axis) - seen.far) < -k.reverse_counts
      => io'.observed.state = "FAULTED" ]_vars

P6_drift ==
  [][ Input1.frame = "GOOD" /\ axis.card_seen /\ IsEnabled(axis) /\ IsEnabled(io'.observed)
      /\ IsSettled
      => ~Beyond(Now(io'.in, io'.axis) - seen.rest_at, k.drift_counts) ]_vars

P7_bounds ==
  [][ /\ io'.command.drive <= k.max_drive
      /\ ~io'.axis.homed => io'.command.drive <= k.unhomed_max_drive
      /\ Driven /\ ~io'.axis.homed /\ ~seen'.homing
         => Along(io'.command.direction, Now(io'.in, io'.axis) - seen'.pressed_at)
            < k.unhomed_travel_counts - k.coast_counts ]_vars

(* Only of a lawful plant. *)
P7_travel ==
  [][ io'.system.mode = "MOTION" /\ ~io'.axis.homed /\ ~seen'.homing
      => ~Beyond(Now(io'.in, io'.axis) - seen'.pressed_at, k.unhomed_travel_counts) ]_vars

P8_latch ==
  [][ /\ system.mode = "LOCKED" /\ ~Accepted(io', {"RESET"})
         => system'.mode = "LOCKED" /\ system'.cause = system.cause
      /\ axis.state = "FAULTED" /\ ~Accepted(io', {"CLEAR_FAULT"})
         => axis'.state = "FAULTED" /\ axis'.fault = axis.fault ]_vars

P10_silence ==
  [][ system.app_age_ticks + 1 >= c.app_timeout_ticks => ~Driven /\ system'.mode # "MOTION" ]_vars

P11_inert_refusal ==
  [][ /\ Len(io'.answers) = Len(io'.in.requests)
      /\ \A i \in 1..Len(io'.answers) :
           io'.answers[i].verdict # "ACCEPTED" => io'.answers[i].inert ]_vars

P12_no_leap == [][ Driven => seen'.asked ]_vars

TypeOK ==
  /\ axis.state \in AxisStates
  /\ axis.fault \in Faults
  /\ (axis.state = "FAULTED") = (axis.fault # "NONE")
  /\ (axis.state = "HOMING") = (axis.homing_phase # "NONE")
  /\ (axis.state = "MOVING") = (axis.lease_ticks > 0)
  /\ axis.state = "HOMING" => ~axis.homed /\ system.mode = "MOTION"
  /\ axis.state = "MOVING" => system.mode = "MOTION"
  /\ system.mode = "LOCKED" => axis.state \in {"DISABLED", "FAULTED"}
  /\ axis.stall_driven_ticks <= k.stall_ticks

-------------------------------------------------------------------------------
(* What the properties are about does happen: each says so. *)
NewFault(fault) == axis.fault = "NONE" /\ axis'.fault = fault

About ==
  [][ /\ Driven => Met("P1_gate")
      /\ axis.state = "MOVING" /\ ReadPedal(c, io'.in) = "RELEASED" => Met("P2_stop")
      /\ io'.gate = "HARD_LIMIT" => Met("P3_hard_limit")
      /\ Driven /\ io'.axis.homed /\ io'.command.direction = "INCREASING"
         /\ io'.axis.position_counts + 1 = k.max_counts - k.coast_counts => Met("P4_soft_limit")
      /\ io'.axis.homed /\ io'.axis.position_counts = k.max_counts - 1 => Met("P4_soft_range")
      /\ NewFault("STALL") => Met("P5_stall")
      /\ NewFault("JUMP") => Met("P6_jump")
      /\ NewFault("REVERSE") => Met("P6_reverse")
      /\ NewFault("DRIFT") => Met("P6_drift")
      /\ io'.command.drive = k.max_drive => Met("P7_bounds")
      /\ io'.system.mode = "MOTION" /\ ~io'.axis.homed /\ ~seen'.homing
         /\ Magnitude(io'.axis.press_travel_counts) = k.unhomed_travel_counts - 1
         => Met("P7_travel")
      /\ axis.state = "FAULTED" /\ axis'.state # "FAULTED" => Met("P8_latch")
      /\ axis.state = "MOVING" /\ ~io'.system.app_alive => Met("P10_silence")
      /\ \A i \in 1..Len(io'.answers) :
           io'.answers[i].verdict = "RANGE" => Met("P11_inert_refusal")
      /\ axis.state = "HOMING" /\ axis'.homed => Met("P12_no_leap") ]_vars
===============================================================================
