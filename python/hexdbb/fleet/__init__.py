"""Many machines' records judged: one row a record and effect value, in a dataset; what it says of the fleet.

=============  =========================================================================================================
columns        the columns of a row
listing        records at URLs as tasks: what is one, what it depends on, copies
judging        one record judged, on a worker: its rows
run            all records judged that are not yet
observed       the rows of a dataset as records and values
worst          machines by their circular deviation
growth         lines through a value over time, and records far off them
shared         values that a group of machines has in common
json_form      the JSON of a report
report         all of it put together
text           it as lines of a terminal
page           it as a page
=============  =========================================================================================================

Workers import this package for `judging`: what reports need is imported from its modules.
"""

from hexdbb.fleet.columns import FLEET, fleet_results
from hexdbb.fleet.listing import Listing, list_records
from hexdbb.fleet.run import judge_records

__all__ = [
    "FLEET",
    "Listing",
    "fleet_results",
    "judge_records",
    "list_records",
]
