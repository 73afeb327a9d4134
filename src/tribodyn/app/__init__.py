"""Browser page for editing a case, running it and studies, and comparing the results.

``tribodyn app`` serves it; only ``server`` and ``results`` load Dash and Flask.

==================  ===================================================================
module              what it does
==================  ===================================================================
``case_form``       fields of a case file as data, from the options of the models
``session``         one tab of the browser: its case, its runs and the current view
``workspace``       the folder to which the page has access, and no other
``jobs``            computations in worker processes, isolated from the page
``worker``          main program of a worker process
``authentication``  token, sessions, host and origin of a request
``studies``         studies that the page offers
``script``          what was done in a tab as a Python script
``results``         layout of case, results and studies on the page
``server``          the web server and its requests
==================  ===================================================================
"""
