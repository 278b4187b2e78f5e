from gaitsim.component import Component, Output


class CenterOfMass(Component):
    """Position and velocity of the center of mass of the whole model, in the world."""

    forward = Output("m", "Position along x.")
    left = Output("m", "Position along y.")
    height = Output("m", "Position along z.")
    forward_velocity = Output("m/s", "Velocity along x.")
    left_velocity = Output("m/s", "Velocity along y.")
    upward_velocity = Output("m/s", "Velocity along z.")

    @staticmethod
    def build(p, mj):
        position, velocity = mj.center_of_mass()
        mj.read("forward", position, "sensordata", 0)
        mj.read("left", position, "sensordata", 1)
        mj.read("height", position, "sensordata", 2)
        mj.read("forward_velocity", velocity, "sensordata", 0)
        mj.read("left_velocity", velocity, "sensordata", 1)
        mj.read("upward_velocity", velocity, "sensordata", 2)
