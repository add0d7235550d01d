/** A navigation program that speaks as much OpenIGTLink as a console test needs: questions without a body. */
import { connect, type Socket } from "node:net";

const HEADER_BYTES = 58;
const HEADER_VERSION = 1;

export class NavigationProgram {
  private constructor(
    private readonly socket: Socket,
    /** Address and port, as the robot sees it. */
    readonly name: string,
  ) {}

  static connect(port: number): Promise<NavigationProgram> {
    return new Promise((resolve, reject) => {
      const socket = connect(port, "127.0.0.1");
      socket.once("error", reject);
      socket.once("connect", () => {
        socket.resume();
        resolve(new NavigationProgram(socket, `127.0.0.1:${socket.localPort}`));
      });
    });
  }

  /** Sends a message of this type and name whose body is empty, so that its CRC is 0. */
  send(type: string, name: string): void {
    const header = Buffer.alloc(HEADER_BYTES);
    header.writeUInt16BE(HEADER_VERSION, 0);
    header.write(type, 2, "ascii");
    header.write(name, 14, "ascii");
    this.socket.write(header);
  }

  /** Resolves when the robot has closed the connection. */
  closed(): Promise<void> {
    return new Promise((resolve) => this.socket.once("close", () => resolve()));
  }

  end(): void {
    this.socket.destroy();
  }
}
