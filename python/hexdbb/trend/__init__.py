"""The trend of a machine over months: records fitted together, what changes between them, limits, change points.

::

    found = trend([dated(record) for record in records], machine)
    found.changing, found.exceeded, found.status
"""

from hexdbb.trend.dated import Dated, dated, parsed_time
from hexdbb.trend.limits import STATUS_ALARM, STATUS_FINE, STATUS_LIMIT, SURE, Exceeded, judged
from hexdbb.trend.series import Series
from hexdbb.trend.trend import DAYS_A_MONTH, Trend, trend

__all__ = [
    "DAYS_A_MONTH",
    "STATUS_ALARM",
    "STATUS_FINE",
    "STATUS_LIMIT",
    "SURE",
    "Dated",
    "Exceeded",
    "Series",
    "Trend",
    "dated",
    "judged",
    "parsed_time",
    "trend",
]
