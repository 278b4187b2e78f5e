from gaitsim.component import Attachment, Component


class Fixed(Component):
    """Holds two segments together without any freedom, such as pelvis and torso of a model without a lumbar joint.

    The child's frame lies where the parent's is, with the same orientation.
    """

    parent = Attachment("The frame that holds.")
    child = Attachment("The frame that is held.")

    @staticmethod
    def build(p, mj):
        pass
