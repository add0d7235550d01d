/** @file Answers each STRING of OpenIGTLink by a STRING of the same name: what Debian's library takes for a
 * reply, to stand beside the app's. Prints its port; ends when its peer does. */
#include <igtlServerSocket.h>
#include <igtlStringMessage.h>

#include <cstdlib>
#include <iostream>

int main(int argc, char** argv) {
  const auto server = igtl::ServerSocket::New();
  const int port = argc == 2 ? std::atoi(argv[1]) : 0;
  if (port == 0 || server->CreateServer(port) != 0) {
    std::cerr << "igtl_echo: cannot listen; usage: igtl_echo PORT\n";
    return 1;
  }
  std::cout << "ready " << port << std::endl;
  const igtl::Socket::Pointer peer = server->WaitForConnection().GetPointer();
  for (;;) {
    const auto header = igtl::MessageHeader::New();
    header->InitPack();
    if (peer->Receive(header->GetPackPointer(), header->GetPackSize()) != header->GetPackSize()) {
      return 0;
    }
    header->Unpack();
    const auto text = igtl::StringMessage::New();
    text->SetMessageHeader(header);
    text->AllocatePack();
    if (peer->Receive(text->GetPackBodyPointer(), text->GetPackBodySize()) != text->GetPackBodySize()) {
      return 0;
    }
    text->Unpack(1);
    const auto answer = igtl::StringMessage::New();
    answer->SetDeviceName(text->GetDeviceName());
    answer->SetString(text->GetString());
    answer->Pack();
    peer->Send(answer->GetPackPointer(), answer->GetPackSize());
  }
}
