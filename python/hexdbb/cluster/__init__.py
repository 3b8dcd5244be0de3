"""Many independent tasks on Dask: a local cluster made for the run, or an existing scheduler by its address.

Model: a task is a key, the hash of its content, and a payload; a function makes rows of a payload; rows become Parquet
files at any URL of fsspec. What is to be done and what became of it is decided here; scheduling, moving of data,
retries and workers that die are Dask's.

=============  =========================================================================================================
options        where to run: number of workers, or the address of a scheduler and its certificates
connection     a client of Dask, its workers checked
environment    which hexdbb a worker has
tasks          what a task is, its key and its seed; how far a run is
running        tasks run, those done before left out, those that fail kept as rows with their error
submitted      calls handed to Dask and taken back as they end
failures       tasks that failed tried again by themselves, so that one cannot take others with it
part           what a worker does with some tasks
worker_process what its process does before: one thread, freed memory kept
results        the Parquet dataset: parts written whole or not at all, keys of what is done
storage        files at a URL, local or in a store
=============  =========================================================================================================

Dask and fsspec are an extra: nothing here imports them before they are needed.
"""

from hexdbb.cluster.connection import Cluster, connected
from hexdbb.cluster.options import ClusterOptions
from hexdbb.cluster.results import Results
from hexdbb.cluster.running import run_tasks
from hexdbb.cluster.storage import Storage, storage_of
from hexdbb.cluster.tasks import Progress, Summary, Task, content_key, seed_of

__all__ = [
    "Cluster",
    "ClusterOptions",
    "Progress",
    "Results",
    "Storage",
    "Summary",
    "Task",
    "connected",
    "content_key",
    "run_tasks",
    "seed_of",
    "storage_of",
]
