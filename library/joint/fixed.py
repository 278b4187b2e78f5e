from gaitsim.component import Attachment, Component


class Fixed(Component):
    """Connects two segments rigidly, such as pelvis and torso of a model without a lumbar joint.

    The child's frame coincides with the parent's.
    """

    parent = Attachment("The frame of the first segment.")
    child = Attachment("The frame of the second segment.")

    @staticmethod
    def build(p, mj):
        pass
