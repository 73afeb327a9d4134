from typing import Any

from tribodyn.cases import cases as cases
from tribodyn.cases import load_case as load_case
from tribodyn.cases import load_result as load_result
from tribodyn.cases import run as run
from tribodyn.cases import warm_up as warm_up
from tribodyn.errors import ComputationError as ComputationError
from tribodyn.errors import InputError as InputError
from tribodyn.errors import ModelWarning as ModelWarning
from tribodyn.study import Case as Case
from tribodyn.study import Result as Result
from tribodyn.study import basins as basins
from tribodyn.study import bifurcation as bifurcation
from tribodyn.study import build_system as build_system
from tribodyn.study import campbell as campbell
from tribodyn.study import compare_results as compare_results
from tribodyn.study import comprehensive_stiffness as comprehensive_stiffness
from tribodyn.study import continuation as continuation
from tribodyn.study import ensemble as ensemble
from tribodyn.study import film_over_operation as film_over_operation
from tribodyn.study import friction_experiment as friction_experiment
from tribodyn.study import harris_map as harris_map
from tribodyn.study import kinematic_frequencies as kinematic_frequencies
from tribodyn.study import loaded_contact as loaded_contact
from tribodyn.study import loss_map as loss_map
from tribodyn.study import lyapunov_exponents as lyapunov_exponents
from tribodyn.study import natural_modes as natural_modes
from tribodyn.study import operating_data as operating_data
from tribodyn.study import optimize_lead as optimize_lead
from tribodyn.study import optimize_tip_relief as optimize_tip_relief
from tribodyn.study import rig_power_flow as rig_power_flow
from tribodyn.study import run_up as run_up
from tribodyn.study import sobol_indices as sobol_indices
from tribodyn.study import speed_sweep as speed_sweep
from tribodyn.study import sweep as sweep
from tribodyn.study import vibration_data as vibration_data
from tribodyn.variants import open_study as open_study
from tribodyn.variants import run_study as run_study

__version__: str

def __getattr__(name: str) -> Any: ...
