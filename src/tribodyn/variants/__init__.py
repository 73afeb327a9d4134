"""Studies of many members: in a file, computed chunk by chunk into a store, here or on a cluster.

| module | what it answers |
|---|---|
| ``study_file`` | what a study file says |
| ``members`` | which members a study has, and how it grows |
| ``compute`` | what is computed of the members of a chunk |
| ``store`` | what is stored, and whether it is whole |
| ``run`` | who computes: this machine or the workers of a Dask cluster |
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
