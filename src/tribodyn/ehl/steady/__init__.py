"""The steady line contact, solved.

| module | what it answers |
|---|---|
| ``line_contact`` | pressure and film of one contact |
| ``batch`` | films of many contacts at once |
| ``solution`` | the result: pressure, film and their errors; temperatures and the balance of heat |
"""
