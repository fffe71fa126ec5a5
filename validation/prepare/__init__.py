"""The file that engines are given: same kinematics, collision geometry that they can use."""
