"""Newton's method for forward kinematics, compiled and in numpy, with proven steps."""
