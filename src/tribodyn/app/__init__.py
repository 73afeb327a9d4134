"""A page in the browser for the whole job: the case as a form, runs, studies, results side by side.

``tribodyn app`` serves it; Dash and Flask are loaded by ``server`` and ``page`` alone.

============  =========================================================================
module        what it does
============  =========================================================================
``form``      fields of a case file as data, made of the options of the models
``desk``      one tab of the browser: its case, its runs, what it looks at
``folder``    the folder that the page may read and write, and nothing beyond it
``jobs``      processes that compute, each of which may end without harm to the page
``worker``    what such a process does
``guard``     who may ask: token, sessions, host and origin of a request
``page``      what stands on the page
``results``   how what was computed stands there
``server``    requests to all of it, and the server
============  =========================================================================
"""
