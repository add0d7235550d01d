---- MODULE Axis ----
VARIABLES drive, pedal
P1_gate == drive # 0 => pedal
====
