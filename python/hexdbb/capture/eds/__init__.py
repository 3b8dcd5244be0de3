"""EDS and DCF files of drives and gauges, as vendors write them.

`sections` reads the lines, `objects` one object, `file` the whole; whether a device can run the test is decided in
`hexdbb.capture.fitness`.
Source: CiA 306-1 (electronic data sheet), CiA 301 (object dictionary, data types).
"""

from hexdbb.capture.eds.file import Eds, read_eds
from hexdbb.capture.eds.objects import EdsObject

__all__ = ["Eds", "EdsObject", "read_eds"]
