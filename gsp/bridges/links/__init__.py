"""The links and joints of a mechanism as all exports have them: frames, bodies, masses, limits."""
