"""The names of active-surface; `__init__.py` reads from here where each comes from."""

import meshes as meshes
from coupling import (
    Case as Case,
    CaseError as CaseError,
    InputError as InputError,
    Result as Result,
    SavedRun as SavedRun,
    build_surface as build_surface,
    read_case as read_case,
    read_run as read_run,
    read_surface as read_surface,
    run_case as run_case,
    surface_motion as surface_motion,
    write_csv as write_csv,
    write_surface as write_surface,
)
from fem_plate import (
    DeflectedPlate as DeflectedPlate,
    Deflection as Deflection,
    InfluenceShapes as InfluenceShapes,
    LargeDeflection as LargeDeflection,
    Modes as Modes,
    PatchedShapes as PatchedShapes,
    Plate as Plate,
    PlateSection as PlateSection,
    PlateShapes as PlateShapes,
    Shapes as Shapes,
    analytic as analytic,
    backbone as backbone,
    neighbour_coupling as neighbour_coupling,
    save_influence as save_influence,
)
from particle import (
    AnyDrive as AnyDrive,
    ConstantFriction as ConstantFriction,
    ContactSamples as ContactSamples,
    CoulombAdhesion as CoulombAdhesion,
    Drive as Drive,
    Energy as Energy,
    Event as Event,
    EventKind as EventKind,
    FrictionTable as FrictionTable,
    HermiteDrive as HermiteDrive,
    Interrupted as Interrupted,
    KogutEtsion as KogutEtsion,
    Micropart as Micropart,
    Outcome as Outcome,
    Samples as Samples,
    Segment as Segment,
    SegmentDrive as SegmentDrive,
    State as State,
    SurfaceMotion as SurfaceMotion,
    SurfaceState as SurfaceState,
    TableDrive as TableDrive,
    Trajectory as Trajectory,
    platform_surface as platform_surface,
    polynomial_surface as polynomial_surface,
    simulate as simulate,
    simulate_many as simulate_many,
)

from . import paper as paper, steering as steering, studies as studies, views as views
from .steering import (
    Aimed as Aimed,
    Planned as Planned,
    Route as Route,
    Settings as Settings,
    Task as Task,
    aim as aim,
    plan as plan,
    read_route as read_route,
    read_task as read_task,
)
from .studies import (
    Study as Study,
    Sweep as Sweep,
    read_study as read_study,
    run_study as run_study,
)
from .views import (
    Animation as Animation,
    animate as animate,
    plot as plot,
    still as still,
    write_run_page as write_run_page,
    write_study_page as write_study_page,
)
