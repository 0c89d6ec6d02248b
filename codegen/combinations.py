"""The combinations of a model's choices: each is a variant, of which a scene needs one."""


def table(models):
    """What every combination chooses, as data for the manifest: names, and for each combination the options and whether they are
    the defaults."""
    return {
        "choices": [{"name": c[0], "options": list(c[1])} for c in models[0].choices],
        "combinations": [
            {"options": [c[3] for c in model.choices], "defaults": [c[3] == c[4] for c in model.choices]} for model in models],
    }


def fitting(models, named):
    """The model that has the options that are named, and the defaults for the others; what names no choice is left out. Where none
    has them, the one of the defaults: whoever asked is told so by who knows where it was written."""
    known = {c[0] for c in models[0].choices}
    named = {k: v for k, v in named.items() if k in known}
    for model in models:
        if all(c[3] == named[c[0]] if c[0] in named else c[3] == c[4] for c in model.choices):
            return model
    return fitting(models, {}) if named else models[0]
