"""What all engines share: gravity and pins."""

GRAVITY = 9.81
"""Along -z of the root link's frame [m/s^2]; every engine is set to it."""
PIN_SOLREF, PIN_SOLIMP = (0.004, 1.0), (0.99, 0.999, 1.0e-4)
"""Of pins that close a loop in MuJoCo: its defaults let a driven four-bar open by 0.4 % of its size, these by 0.004 %
at the default step."""
