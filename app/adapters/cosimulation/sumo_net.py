"""The road and the traffic as SUMO's files: nodes, edges, crossing, departures.

SUMO's `netconvert` joins them. It makes a crossing only between lanes that persons may not use;
where they may not, SUMO's cars do not see a person outside the crossing and drive through them
(0.05 to 0.11 m away, no collision reported). So the permission is added to the finished net:
then cars stop for a person anywhere on the carriageway.
"""

import subprocess
from collections.abc import Sequence
from pathlib import Path
from xml.etree import ElementTree as ET

from app.science.cosimulation import CosimulationError, Departure, Road

CAR_LENGTH_M, CAR_WIDTH_M = 4.5, 1.8
CAR_TYPE, FOREIGN_TYPE, WAITING_EDGE = "car", "foreign", "near-out"
ROUTES = {"near": ("near-in", "near-out"), "far": ("far-in", "far-out")}
_NET, _ROUTES = "road.net.xml", "traffic.rou.xml"
_ENDS = {"near-in": ("west", "middle"), "near-out": ("middle", "east"),
         "far-in": ("east", "middle"), "far-out": ("middle", "west")}  # fmt: skip
_NO_PERSONS = "disallow", "pedestrian"


def write_files(
    folder: Path, road: Road, plan: Sequence[Departure], netconvert: Path
) -> tuple[Path, Path]:
    """Write net and routes to a folder; return their paths.

    Raises:
        CosimulationError: netconvert refuses the road.
    """
    net, routes = folder / _NET, folder / _ROUTES
    sources = {
        "--node-files": ("nodes.xml", _nodes(road)),
        "--edge-files": ("edges.xml", _edges(road)),
        "--connection-files": ("connections.xml", _connections(road)),
    }
    options: list[str] = []
    for option, (name, tree) in sources.items():
        _write(folder / name, tree)
        options += [option, str(folder / name)]
    fixed = ["--offset.disable-normalization", "--no-turnarounds", "--walkingareas"]
    command = [str(netconvert), *options, *fixed, "--xml-validation", "never", "-o", str(net)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)  # noqa: S603
    if done.returncode or not net.exists():
        raise CosimulationError(f"netconvert refuses the road: {done.stderr.strip()}")
    made = ET.parse(net)  # noqa: S314 - netconvert has just written it
    for lane in made.iter("lane"):
        if lane.get(_NO_PERSONS[0]) == _NO_PERSONS[1]:
            del lane.attrib[_NO_PERSONS[0]]
    made.write(net, encoding="utf-8", xml_declaration=True)
    _write(routes, _traffic(plan))
    return net, routes


def _nodes(road: Road) -> ET.Element:
    nodes, end_m = ET.Element("nodes"), road.half_length_m
    for name, x_m in (("west", -end_m), ("middle", 0.0), ("east", end_m)):
        _add(nodes, "node", id=name, x=x_m, y=0.0, type="priority")
    return nodes


def _edges(road: Road) -> ET.Element:
    edges = ET.Element("edges")
    for name, (start, end) in _ENDS.items():
        edge = _add(edges, "edge", id=name, to=end, numLanes=2, speed=road.speed_limit_m_s)
        edge.set("from", start)
        _add(edge, "lane", index=0, allow="pedestrian", width=road.pavement_width_m)
        _add(edge, "lane", index=1, disallow="pedestrian", width=road.lane_width_m)
    return edges


def _connections(road: Road) -> ET.Element:
    connections = ET.Element("connections")
    for start, end in ROUTES.values():
        _add(connections, "connection", to=end, fromLane=1, toLane=1).set("from", start)
    if road.crossing_width_m is not None:
        edges, width = "near-out far-in", road.crossing_width_m
        _add(connections, "crossing", node="middle", edges=edges, priority="true", width=width)
    return connections


def _traffic(plan: Sequence[Departure]) -> ET.Element:
    routes = ET.Element("routes")
    size = {"length": CAR_LENGTH_M, "width": CAR_WIDTH_M}
    for kind in (CAR_TYPE, FOREIGN_TYPE):
        _add(routes, "vType", id=kind, vClass="passenger", **size)
    for lane, edges in ROUTES.items():
        _add(routes, "route", id=lane, edges=" ".join(edges))
    for one in plan:
        _add(routes, "vehicle", id=one.name, type=CAR_TYPE, route=one.lane, depart=one.time_s,
             departLane=1, departSpeed=one.speed_m_s)  # fmt: skip
    return routes


def _add(parent: ET.Element, tag: str, **values: object) -> ET.Element:
    return ET.SubElement(parent, tag, {key: str(value) for key, value in values.items()})


def _write(path: Path, root: ET.Element) -> None:
    ET.ElementTree(root).write(path, encoding="utf-8", xml_declaration=True)
