"""What a user's function must give at each port: the shape of one sample's push."""

SHAPES: dict[str, tuple[int, ...]] = {
    "slider": (6,),
    "leg": (6,),
    "slider_joint": (6, 3),
    "platform_joint": (6, 3),
    "ball": (3,),
    "cup": (3,),
    "reading": (),
}
"""Shape of one sample's push, by port."""
