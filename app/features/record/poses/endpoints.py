"""The way in for consoles that watch."""

import asyncio

from fastapi import APIRouter
from starlette.websockets import WebSocket

from app.features.record.poses.socket import serve_poses

router = APIRouter(tags=["sessions"])


@router.websocket("/sessions/{session_id}/pose")
async def show_poses(socket: WebSocket, session_id: str) -> None:
    """The movement of a session, as it comes."""
    try:
        await serve_poses(socket, socket.app.state.context, session_id)
    except asyncio.CancelledError:
        return
