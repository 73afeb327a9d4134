from tribodyn.signals.cepstrum import Cepstrum as Cepstrum
from tribodyn.signals.cepstrum import cepstrum as cepstrum
from tribodyn.signals.cepstrum import lifter as lifter
from tribodyn.signals.condition_indicators import ConditionIndicators as ConditionIndicators
from tribodyn.signals.condition_indicators import condition_indicators as condition_indicators
from tribodyn.signals.cyclic_coherence import CyclicCoherence as CyclicCoherence
from tribodyn.signals.cyclic_coherence import cyclic_coherence as cyclic_coherence
from tribodyn.signals.demodulation import NarrowbandDemodulation as NarrowbandDemodulation
from tribodyn.signals.demodulation import narrowband_demodulation as narrowband_demodulation
from tribodyn.signals.envelope import Kurtogram as Kurtogram
from tribodyn.signals.envelope import kurtogram as kurtogram
from tribodyn.signals.gear_indicators import energy_ratio as energy_ratio
from tribodyn.signals.gear_indicators import fm0 as fm0
from tribodyn.signals.gear_indicators import fm4 as fm4
from tribodyn.signals.gear_indicators import kurtosis as kurtosis
from tribodyn.signals.gear_indicators import m6a as m6a
from tribodyn.signals.gear_indicators import m8a as m8a
from tribodyn.signals.gear_indicators import na4 as na4
from tribodyn.signals.gear_indicators import na4_star as na4_star
from tribodyn.signals.gear_indicators import nb4 as nb4
from tribodyn.signals.gear_indicators import sideband_index as sideband_index
from tribodyn.signals.gear_indicators import sideband_level_factor as sideband_level_factor
from tribodyn.signals.synchronous_average import SynchronousAverage as SynchronousAverage
from tribodyn.signals.synchronous_average import locked_variance as locked_variance
from tribodyn.signals.synchronous_average import (
    time_synchronous_average as time_synchronous_average,
)
