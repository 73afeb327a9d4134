"""Studies of many runs (members), computed in chunks into a store, on one machine or a cluster.

| module | content |
|---|---|
| ``study_file`` | reading of study files |
| ``compute`` | the members of a study, how it grows, computation of a chunk |
| ``store`` | stored chunks, checks that they are complete, all as one lazy data set |
| ``run`` | execution on this machine or on the workers of a Dask cluster |
"""

from tribodyn.arguments import guard
from tribodyn.variants.run import run_study
from tribodyn.variants.store import StudyState, open_study, study_state
from tribodyn.variants.study_file import Study, load_study, read_study

__all__ = [
    "Study",
    "StudyState",
    "load_study",
    "open_study",
    "read_study",
    "run_study",
    "study_state",
]

guard(__name__)
