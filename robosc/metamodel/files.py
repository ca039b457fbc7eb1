"""Which file a model came from."""

from pyecore.resources import URI, Resource

from robosc.metamodel import robosc


def set_path(base: robosc.Base, path: str) -> None:
    """Notes the file that a robot or library was read from, as its user wrote it; `file` becomes its bare name."""
    Resource(URI(path)).append(base)
    base.file = path.replace("\\", "/").rpartition("/")[2]


def path_of(base: robosc.Base) -> str:
    """The file that a robot or library was read from, as its user wrote it; its bare name where only that is known."""
    resource: Resource | None = getattr(base, "eResource", None)
    return str(resource.uri.plain) if resource is not None and resource.uri is not None else str(base.file or "")
