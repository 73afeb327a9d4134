from tribodyn.cases.catalogue import case_files as case_files
from tribodyn.cases.catalogue import cases as cases
from tribodyn.cases.compile_ahead import warm_up as warm_up
from tribodyn.cases.load import load_case as load_case
from tribodyn.cases.load import load_result as load_result
from tribodyn.cases.load import run as run
from tribodyn.cases.papers.comparison import PaperComparison as PaperComparison
from tribodyn.cases.papers.comparison import compare_with_paper as compare_with_paper
