------------------------------- MODULE KernelOne ------------------------------
(* One axis, the system, and a plant: what the models KernelStall, KernelRunaway,
   KernelHoming, KernelLimits and KernelLive share. One step is one tick. Each of them
   says what the world may do in a tick, and keeps in `seen` what its witness has
   counted, who sees inputs, requests with verdicts and outputs, and none of the
   kernel's marks and counts. *)
EXTENDS Kernel, Meets

CONSTANTS c,        \* the system's configuration, see SmallSystem
          k,        \* the axis' configuration
          Lawful,   \* TRUE: driven, the plant goes that way or sticks; undriven, it
                    \* coasts no farther than it may from the last driven reading
          Without,  \* of "stall", "reverse", "drift", "travel", "time", "hand": what this
                    \* model does not look at; the kernel forgets it in every tick
          body      \* mechanical range, low to high; at or below `closes` the switch
                    \* is triggered, above `opens` it is open, in between it reads either

SmallSystem ==
  [ pedal_channels |-> 1, app_timeout_ticks |-> 2, lease_max_ticks |-> 2,
    power_up_ticks |-> 1, pedal_debounce_ticks |-> 1, pedal_disagree_ticks |-> 1,
    bad_frame_limit |-> 2, overrun_limit |-> 2 ]

(* An axis whose limits are all out of reach; each model brings those near that it is about. *)
WideAxis ==
  [ limit_side |-> "NONE", min_counts |-> -20, max_counts |-> 20, home_offset_counts |-> 0,
    coast_counts |-> 1, deadband_counts |-> 0, noise_counts |-> 1, max_drive |-> 2,
    unhomed_max_drive |-> 1, unhomed_travel_counts |-> 40, home_drive |-> 1,
    home_slow_drive |-> 1, home_travel_counts |-> 40, home_clear_counts |-> 2,
    home_tolerance_counts |-> 1, home_timeout_ticks |-> 40, switch_hysteresis_counts |-> 0,
    switch_debounce_ticks |-> 2, rest_ticks |-> 1, stall_ticks |-> 20,
    stall_effort_ticks |-> 20, stall_min_counts |-> 1, reverse_counts |-> 40,
    drift_counts |-> 40, max_delta_counts |-> 40, required |-> TRUE ]

Free == [low |-> -20, high |-> 20, closes |-> -30, opens |-> -30]

X == 0         \* the axis' slot
K == (X :> k)

VARIABLES
  system, axis,  \* the kernel's records
  plant,         \* where the axis is
  seen,          \* what the witness has counted
  io             \* the last tick

vars == <<system, axis, plant, seen, io>>

(* Two states that differ in io alone are one; properties of a tick are checked on
   every step, repeated ones included. *)
View == <<system, axis, plant, seen>>

-------------------------------------------------------------------------------
(* What no later tick looks at is set to one value, so that states that will behave
   alike are one: each of these is written anew before it is read. One is a choice of
   the model: an axis that is not homed and holds no setpoint takes up its position at
   the raw counter. Each field is written once: that is what TLC is quick at. *)
Forget(a) ==
  LET held   == a.lease_ticks > 1
      raw    == IF a.card_seen THEN a.raw ELSE 0
      seeks  == a.switch_triggered /\ a.homing_phase \in {"APPROACH", "APPROACH_SLOWLY"}
      backs  == a.card_seen /\ a.homing_phase \in {"BACK_OFF", "BACK_OFF_AGAIN"}
      edges  == a.homing_phase \in {"BACK_OFF_AGAIN", "APPROACH_SLOWLY", "REST"}
      stalls == "stall" \notin Without
      marks  == stalls /\ a.card_seen /\ a.stall_direction # "NONE"
      turns  == "reverse" \notin Without
      drifts == "drift" \notin Without /\ ~MovableByHand(system', a)
      press  == system'.mode = "MOTION"
      paths  == press /\ "travel" \notin Without
      quiet  == [low |-> raw, high |-> raw, ticks |-> k.rest_ticks]
  IN  [ state |-> a.state, fault |-> a.fault, fault_now |-> FALSE, disabled_now |-> FALSE,
        homed |-> a.homed, card_valid |-> FALSE, card_seen |-> a.card_seen, bad_frames |-> a.bad_frames,
        ticks_since_frame |-> IF a.card_seen THEN a.ticks_since_frame ELSE 0,
        raw               |-> raw,
        position_counts   |-> IF IsHomed(a) \/ held THEN a.position_counts ELSE raw,
        switch_triggered  |-> a.switch_triggered, switch_ticks |-> a.switch_ticks,
        switch_raw        |-> IF seeks THEN a.switch_raw ELSE 0, switch_now |-> FALSE,
        setpoint_counts   |-> IF held THEN a.setpoint_counts ELSE 0,
        drive             |-> IF held THEN a.drive ELSE 0,
        lease_ticks       |-> a.lease_ticks, driven_direction |-> a.driven_direction,
        rest              |-> IF a.card_seen /\ ~WasDriven(a) THEN a.rest ELSE RunAt(raw),
        hand              |-> IF ~a.card_seen THEN RunAt(0) ELSE IF "hand" \in Without THEN quiet ELSE a.hand,
        stall_ticks       |-> IF stalls THEN a.stall_ticks ELSE 0,
        stall_effort      |-> IF stalls THEN a.stall_effort ELSE 0,
        stall_direction   |-> IF stalls THEN a.stall_direction ELSE "NONE",
        stall_mark        |-> IF marks THEN a.stall_mark ELSE 0,
        effort_mark       |-> IF marks THEN a.effort_mark ELSE 0,
        reverse_direction |-> IF turns THEN a.reverse_direction ELSE "NONE",
        reverse_mark      |-> IF turns /\ a.card_seen /\ a.reverse_direction # "NONE" THEN a.reverse_mark ELSE 0,
        drift_mark        |-> IF a.card_seen /\ drifts THEN a.drift_mark ELSE raw,
        runaway           |-> a.runaway,
        travel_mark       |-> IF paths /\ a.card_seen THEN a.travel_mark ELSE 0,
        travel_by         |-> IF paths THEN a.travel_by ELSE "MOVE",
        move_travel       |-> IF paths THEN a.move_travel ELSE 0,
        home_travel       |-> IF paths THEN a.home_travel ELSE 0,
        homing_phase      |-> a.homing_phase,
        homing_ticks      |-> IF press /\ "time" \notin Without THEN a.homing_ticks ELSE 0,
        homing_mark       |-> IF backs THEN a.homing_mark ELSE 0,
        first_edge        |-> IF edges THEN a.first_edge ELSE 0,
        second_edge       |-> IF a.homing_phase = "REST" THEN a.second_edge ELSE 0 ]

ForgetSystem(s) == [s EXCEPT !.causes_seen = {}, !.app_alive = FALSE, !.estop = FALSE,
                             !.runaway = FALSE, !.pedal = "DISAGREE"]

-------------------------------------------------------------------------------
(* The plant: `at` in raw counts, and if it is lawful how it is driven, and how far
   it may still coast in which sense. *)
Standing(at) == [at |-> at, driven |-> "NONE", sense |-> "NONE", coast |-> 0]

Sense(direction) == Along(direction, 1)

(* Driven, a count that way or none; else on for as far as it may coast. *)
LawfulMoves ==
  {0} \union (IF plant.driven # "NONE" THEN {Sense(plant.driven)} ELSE {})
      \union (IF plant.coast > 0 THEN {Sense(plant.sense)} ELSE {})

Inside(m) == plant.at + m \in body.low..body.high

(* The farthest from the last driven reading is coast_counts, noise included. *)
Coasted(m, direction) ==
  LET goes == IF m > 0 THEN "INCREASING" ELSE "DECREASING"
      left == IF plant.driven = goes THEN k.coast_counts - k.noise_counts ELSE plant.coast
  IN  [ at     |-> plant.at + m,
        driven |-> direction,
        sense  |-> IF m # 0 /\ left > 1 THEN goes ELSE "NONE",
        coast  |-> IF m # 0 /\ left > 1 THEN left - 1 ELSE 0 ]

Moved(m, direction) ==
  IF Lawful THEN Coasted(m, direction) ELSE Standing(plant.at + m)

(* What a switch may truly read. *)
Contact(at) ==
  IF k.limit_side = "NONE" \/ at > body.opens THEN {FALSE}
  ELSE IF at <= body.closes THEN {TRUE} ELSE BOOLEAN

Reading(raw, switch) == [valid |-> TRUE, raw |-> raw, switch |-> switch, reset |-> FALSE]
Lost                 == [valid |-> FALSE, raw |-> 0, switch |-> FALSE, reset |-> FALSE]

-------------------------------------------------------------------------------
(* Inputs and requests. The number of a press is 1, that of any other 2. *)
Ask(kind) == [kind |-> kind, door |-> "INTACT", axis |-> X, holder |-> 1,
              target |-> 0, drive |-> 0, lease |-> 0, consent |-> 1]

MoveTo(target, drive, lease) ==
  [Ask("MOVE") EXCEPT !.target = target, !.drive = drive, !.lease = lease]

Beat == Ask("HEARTBEAT")

Input(pedal, reading, requests) ==
  [ pedal_no |-> pedal, pedal_nc |-> "OPEN", estop_loop |-> "CLOSED", missed |-> 0,
    new_attachment |-> FALSE, config_pass |-> "NONE", any_valid |-> FALSE, consent |-> 1,
    readings |-> (X :> reading), requests |-> requests, state_damaged |-> FALSE ]

(* As a person would hold it: pressed in MOTION and, once armed, to get there. *)
Held    == IF system.mode = "MOTION" \/ system.pedal_armed THEN "CLOSED" ELSE "OPEN"
NotHeld == IF Held = "CLOSED" THEN "OPEN" ELSE "CLOSED"

-------------------------------------------------------------------------------
(* A tick *)
Kernel0 == [system |-> system, axes |-> (X :> axis)]

(* What io keeps of an answer. *)
Outcome(answer) == [request |-> answer.request, verdict |-> answer.verdict,
                    inert |-> answer.after = answer.before]

Told(in, tick) ==
  [ in |-> in, command |-> tick.command[X], gate |-> tick.gate[X],
    answers |-> [i \in 1..Len(tick.answers) |-> Outcome(tick.answers[i])],
    system |-> tick.system, axis |-> tick.axes[X], observed |-> tick.observed.axes[X] ]

(* A tick for each of the `tails`, which come behind the requests of `in`. A value bound
   as the element of a set is evaluated once: what is the same for all tails is shared. *)
Tock(in, m, tails) ==
  \E observed \in {Observed(c, K, Kernel0, in)} :
  \E answered \in {AnswerAll(c, K, observed, in.requests, <<>>)}, tail \in tails :
  \E tick \in {Finished(K, observed, AnswerAll(c, K, answered.kernel, tail, answered.answers))} :
    /\ system' = ForgetSystem(tick.system)
    /\ axis' = Forget(tick.axes[X])
    /\ plant' = Moved(m, tick.command[X].direction)
    /\ io' = Told([in EXCEPT !.requests = @ \o tail], tick)

(* The search begins where power has just come on, or where MOTION has begun with the
   axis enabled: the inputs that lead there are part of the model. *)
RECURSIVE After(_, _)
After(kernel, inputs) ==
  IF inputs = <<>> THEN kernel
  ELSE LET tick == Tick(c, K, kernel, Head(inputs))
       IN  After([system |-> tick.system, axes |-> tick.axes], Tail(inputs))

PowerOn == [system |-> Booted(c, TRUE, 1), axes |-> (X :> BlankAxis)]

(* Until all is at rest and power is up; then what is asked for; then the press. *)
IntoMotion(at, requests) ==
  LET Still(pedal, asked) == Input(pedal, Reading(at, at <= body.closes), <<Beat>> \o asked)
      rest == [i \in 1..(k.rest_ticks + k.switch_debounce_ticks + 1) |-> Still("OPEN", <<>>)]
  IN  <<Still("OPEN", <<>>), Still("OPEN", <<Ask("RESET")>>)>> \o rest
      \o <<Still("OPEN", requests), Still("CLOSED", <<>>)>>

BeginIn(kernel, at) ==
  /\ system = ForgetSystem(kernel.system)
  /\ axis = [kernel.axes[X] EXCEPT !.card_valid = FALSE, !.switch_now = FALSE, !.switch_raw = 0,
               !.travel_mark = IF "travel" \in Without THEN 0 ELSE @,
               !.hand = [low |-> at, high |-> at, ticks |-> k.rest_ticks]]
  /\ plant = Standing(at)
  /\ io = [command |-> NoDrive]

-------------------------------------------------------------------------------
(* Properties that every one of these models is held against; io' is this very tick:
   `in` what came in, `system` and `axis` the records at its end, `observed` the axis'
   record before any request was answered. *)
Driven == io'.command.drive # 0
Read1  == io'.in.readings[X]

Accepted(kinds) ==
  \E i \in 1..Len(io'.answers) :
    io'.answers[i].request.kind \in kinds /\ io'.answers[i].verdict = "ACCEPTED"

P1_gate ==
  [][ Driven =>
        /\ io'.system.mode = "MOTION" /\ Power(io'.system)
        /\ ReadPedal(c, io'.in) = "PRESSED"
        /\ io'.in.estop_loop = "CLOSED"
        /\ Read1.valid
        /\ io'.axis.state \in {"MOVING", "HOMING"}
        /\ io'.axis.lease_ticks > 0 \/ io'.axis.state = "HOMING" ]_vars

P2_stop ==
  [][ (\/ ReadPedal(c, io'.in) # "PRESSED"
       \/ io'.in.estop_loop # "CLOSED"
       \/ io'.system.mode \in {"LOCKED", "READY"}
       \/ io'.system.bus_bad_ticks >= c.bad_frame_limit
       \/ ~io'.system.app_alive)
      => ~Driven ]_vars

P3_hard_limit ==
  [][ k.limit_side # "NONE" /\ Driven /\ (Read1.switch \/ ~Read1.valid)
      => io'.command.direction # TowardsSwitch(k) ]_vars

P8_latch ==
  [][ /\ system.mode = "LOCKED" /\ ~Accepted({"RESET"})
         => system'.mode = "LOCKED" /\ system'.cause = system.cause
      /\ axis.state = "FAULTED" /\ ~Accepted({"CLEAR_FAULT"})
         => axis'.state = "FAULTED" /\ axis'.fault = axis.fault ]_vars

P10_silence ==
  [][ system.app_age_ticks + 1 >= c.app_timeout_ticks => ~Driven /\ system'.mode # "MOTION" ]_vars

P11_inert_refusal ==
  [][ /\ Len(io'.answers) = Len(io'.in.requests)
      /\ \A i \in 1..Len(io'.answers) :
           io'.answers[i].verdict # "ACCEPTED" => io'.answers[i].inert ]_vars

(* Only what carries the number of this press moves anything. *)
P12_no_leap ==
  [][ \A i \in 1..Len(io'.answers) :
        io'.answers[i].request.kind \in {"MOVE", "HOME"} /\ io'.answers[i].verdict = "ACCEPTED"
        => io'.answers[i].request.consent = 1 ]_vars

TypeOK ==
  /\ axis.state \in AxisStates
  /\ axis.fault \in Faults
  /\ (axis.state = "FAULTED") = (axis.fault # "NONE")
  /\ (axis.state = "HOMING") = (axis.homing_phase # "NONE")
  /\ (axis.state = "MOVING") = (axis.lease_ticks > 0)
  /\ axis.state = "HOMING" => ~IsHomed(axis) /\ system.mode = "MOTION"
  /\ axis.state = "MOVING" => system.mode = "MOTION"
  /\ system.mode = "LOCKED" => axis.state \in {"DISABLED", "FAULTED"}

(* What they are about does happen: each says so. *)
NewFault(fault) == axis.fault = "NONE" /\ axis'.fault = fault

About1 ==
  /\ Driven => Met("P1_gate")
  /\ axis.state \in {"MOVING", "HOMING"} /\ ReadPedal(c, io'.in) = "RELEASED" => Met("P2_stop")
  /\ io'.gate = "HARD_LIMIT" => Met("P3_hard_limit")
  /\ axis.state = "FAULTED" /\ axis'.state # "FAULTED" => Met("P8_latch")
  /\ axis.state = "MOVING" /\ ~io'.system.app_alive => Met("P10_silence")
  /\ (\E i \in 1..Len(io'.answers) : io'.answers[i].verdict # "ACCEPTED") => Met("P11_inert_refusal")
===============================================================================
