"""A figure of one's own: the force of the mesh against its compression."""

import plotly.graph_objects as go

from tribodyn.drawing import drawing


@drawing(
    "force_over_compression",
    heading="Force over compression",
    caption="A straight line is a linear mesh; a loop is damping.",
    of="Result",
)
def force_over_compression(result):
    """Draw the mesh force of a result over the compression of its mesh."""
    motion = result.response
    line = go.Scatter(x=motion.deflection[:, 0] * 1e6, y=motion.contact_force.sum(axis=1))
    return go.Figure(line).update_layout(
        xaxis_title="Compression [um]", yaxis_title="Mesh force [N]"
    )
