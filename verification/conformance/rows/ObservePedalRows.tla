--------------------------- MODULE ObservePedalRows ---------------------------
(* Phase 3, the part that concerns pedal and app. The records hold what it may
   read and nothing else: TLC fails at any other field. That the phase is this part
   and then that of ObserveDeadlineRows is assumed last, for every state and every
   input, and TLC looks at each. *)
EXTENDS System, TLC

CONSTANTS app_timeout_ticks, pedal_debounce_ticks, pedal_disagree_ticks

Unread == <<"unread">>

Configuration(channels) ==
  [ pedal_channels |-> channels, app_timeout_ticks |-> app_timeout_ticks,
    pedal_debounce_ticks |-> pedal_debounce_ticks, pedal_disagree_ticks |-> pedal_disagree_ticks ]

Part(c, s, in) == ObservePedal(c, ObserveApp(c, s, in), in)

ASSUME
  \A channels \in {1, 2}, no \in Contacts, nc \in Contacts, mode \in Modes, attached \in BOOLEAN,
     age \in 0..app_timeout_ticks, armed \in BOOLEAN, pressed \in 0..pedal_debounce_ticks,
     released \in 0..pedal_debounce_ticks, disagree \in 0..(pedal_disagree_ticks + 1) :
    LET before ==
          [ mode |-> mode, app_age_ticks |-> age, app_alive |-> Unread, pedal |-> Unread,
            pedal_armed |-> armed, pedal_pressed_ticks |-> pressed, pedal_released_ticks |-> released,
            pedal_disagree_ticks |-> disagree ]
        in == [pedal_no |-> no, pedal_nc |-> nc, new_attachment |-> attached]
        s == Part(Configuration(channels), before, in)
    IN PrintT(<< channels, no, nc, mode, attached, age, armed, pressed, released, disagree,
                 s.app_age_ticks, s.app_alive, s.pedal, s.pedal_pressed_ticks, s.pedal_released_ticks,
                 s.pedal_disagree_ticks >>)

ASSUME
  \A no \in Contacts, nc \in Contacts, mode \in Modes, attached \in BOOLEAN, missed \in BOOLEAN,
     overruns \in 0..1, loop \in Contacts, armed \in BOOLEAN, pressed \in 0..pedal_debounce_ticks :
    LET c == [overrun_limit |-> 1] @@ Configuration(2)
        before ==
          [ mode |-> mode, app_age_ticks |-> 0, app_alive |-> Unread, pedal |-> Unread,
            pedal_armed |-> armed, pedal_pressed_ticks |-> pressed, pedal_released_ticks |-> 0,
            pedal_disagree_ticks |-> 0, overruns_in_row |-> overruns, estop |-> Unread ]
        in == [ pedal_no |-> no, pedal_nc |-> nc, new_attachment |-> attached,
                deadline_missed |-> missed, estop_loop |-> loop ]
    IN ObserveSystem(c, before, in) = ObserveEstop(ObserveDeadline(c, Part(c, before, in), in), in)
===============================================================================
