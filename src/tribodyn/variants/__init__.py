"""Studies of many runs (members), computed in chunks into a store, on one machine or a cluster.

| module | content |
|---|---|
| ``study_file`` | reading of study files |
| ``members`` | the members of a study, and how a study grows |
| ``compute`` | computation of the members of a chunk |
| ``store`` | stored chunks, and checks that they are complete |
| ``run`` | execution on this machine or on the workers of a Dask cluster |
| ``dataset`` | the store as one lazy data set |
"""

from tribodyn.arguments import guard
from tribodyn.variants.dataset import open_study
from tribodyn.variants.run import run_study
from tribodyn.variants.store import StudyState, study_state
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
